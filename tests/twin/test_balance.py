"""All fibres side by side: energy, the orders of step and mesh, agreement on taut motion, and the released weight."""

from __future__ import annotations

import math

import numpy as np
import pytest

import twin.rigs
from stand.setup import nominal
from tests.twin.fibre_runs import DT, held, run, sine, smooth
from twin.model import Start
from twin.plugins import load
from twin.rigs import Rig, release

FIBRES = ("point-mass", "ancf", "finite-segment", "ritz")
SLIPPERY = {name: {} if name == "ritz" else {"pulley_friction": 0.0} for name in FIBRES}


@pytest.mark.parametrize("name", FIBRES)
def test_work_put_in_is_stored_or_lost_in_the_fibres_damping(name: str) -> None:
    """Without friction: work = weight's energy + strain's + tau times the square of its rate, and what the fibre holds.

    Bound: the fibre's and the rim's own kinetic energy (they move no faster than the drive), and its weight's.
    """
    setup, (x, w) = smooth(), sine(1.25, 0.03, 1.0)
    out = run(name, setup, x, w, SLIPPERY[name])
    force, v, speed = out[:, 2], out[:, 1], w[1:]
    work = np.cumsum(force * speed) * DT
    stiff = setup.fibre_stiffness
    stretch = x[1:] - out[:, 0]  # beyond that at rest
    stored = 0.5 * setup.mass * v**2 + setup.rest_tension * x[1:] + 0.5 * stiff * stretch**2
    lost = np.cumsum(setup.fibre_damping * (speed - v) ** 2) * DT
    light = setup.fibre_mass + setup.pulley_inertia / setup.pulley_radius**2
    bound = 0.5 * light * np.max(speed**2) + setup.fibre_mass * setup.gravity * np.ptp(x) + 1e-3 * np.ptp(work)
    assert np.ptp(work) > 100 * bound
    assert np.abs(work - stored - lost).max() < bound


@pytest.mark.parametrize(
    ("name", "least"), [("point-mass", 1.9), ("finite-segment", 1.7), ("ritz", 1.9), ("ancf", 1.7)]
)
def test_halving_the_step_quarters_the_error(name: str, least: float) -> None:
    x, w = sine(0.15, 0.03, 2.0)
    own = SLIPPERY[name] | ({"segments": 20, "fine_segments": 14} if name == "finite-segment" else {})
    fine = run(name, smooth(), x, w, {**own, "step": DT / 16})[:, 0]
    errors = [np.abs(run(name, smooth(), x, w, {**own, "step": DT / k})[:, 0] - fine).max() for k in (1, 2)]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.3), errors


def test_finer_ancf_elements_converge_faster_than_their_length_squared() -> None:
    x, w = sine(0.2, 0.02, 1.0)
    u = {n: run("ancf", smooth(), x, w, {"elements": n, "fine_elements": n * 14 // 18})[:, 0] for n in (9, 18, 72)}
    errors = [np.abs(u[n] - u[72]).max() for n in (9, 18)]
    assert math.log2(errors[0] / errors[1]) > 2.0, errors
    assert errors[1] < 1e-3 * np.ptp(u[72])


#: share of the range of u by which a model may differ from the force model on taut motion, and why
TAUT = {
    "ritz": 1e-4,  # the fibre's mass
    "point-mass": 2e-3,  # the arc stretches, and slips over the rim's bond
    "ancf": 4e-3,  # rim and bristles yield, too
    "finite-segment": 4e-3,  # and the fibre has corners
}


@pytest.mark.parametrize("name", FIBRES)
def test_on_taut_motion_every_fibre_agrees_with_the_force_model_to_its_modelling_error(name: str) -> None:
    x, w = sine(0.5, 0.03, 1.0)
    force, fibre = run("force", nominal(), x, w)[:, 0], run(name, nominal(), x, w)[:, 0]
    assert np.abs(force - fibre).max() < TAUT[name] * np.ptp(force)


@pytest.mark.parametrize("height", [0.005, 0.02])
@pytest.mark.parametrize("name", ["weight-fibre-30", "weight-fibre-45", "weight-fibre-90"])
def test_a_released_weight_falls_by_its_law_and_is_caught(name: str, height: float) -> None:
    """h = a t^2 / 2 until the fibre is straight, a = g sin(alpha) - F_c/m; then it comes to rest within friction."""
    setup = load(twin.rigs, name, Rig).setup()
    drop = release(setup, height).drop_height
    out = run("force", setup, *held(2.0), start=Start(u=drop, force=0.0))
    fall = setup.gravity * math.sin(setup.incline_angle) - setup.guide_friction / setup.mass
    slack = setup.rest_tension / setup.fibre_stiffness  # the fibre is straight this far above rest
    caught = int(np.flatnonzero(out[:, 2] > 0.0)[0])
    assert (caught + 1) * DT == pytest.approx(math.sqrt(2 * (drop - slack) / fall), rel=0.03, abs=2 * DT)
    assert out[caught, 1] == pytest.approx(-math.sqrt(2 * fall * (drop - slack)), rel=0.05)
    assert out[:, 2].max() > 3 * setup.rest_tension
    assert out[-1, 2] == pytest.approx(setup.rest_tension, abs=setup.guide_friction + 0.05)
    assert abs(out[-1, 0]) < (setup.guide_friction + 0.1) / setup.fibre_stiffness + 1e-5
