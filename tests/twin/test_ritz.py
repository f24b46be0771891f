"""The Ritz model of strands with variable free length against its own linear system and the other fibres."""

from __future__ import annotations

import math

import numpy as np
import pytest

from stand.setup import Setup, nominal
from tests.twin.fibre_runs import (
    DT,
    chain,
    damped,
    free_vibration,
    frequency,
    hanging,
    held,
    model,
    run,
    sine,
    smooth,
    trapezoid,
)
from twin.model import Start
from twin.rigs import axial_stiffness

NAME = "ritz"


def two_rods(setup: Setup, cells: int = 40) -> float:
    """Hz of two rods with the fibre's mass, the pulley between them; the arc neither stretches nor weighs."""
    arc = setup.pulley_radius * setup.wrap_angle
    density, stiff = setup.fibre_mass / (setup.free_length + arc), axial_stiffness(setup)
    lengths = (setup.weight_strand_length, setup.drive_strand_length)
    mass, springs = np.zeros(2 * cells + 1), []
    mass[0], mass[cells] = setup.mass, setup.pulley_inertia / setup.pulley_radius**2
    for i in range(2 * cells):
        length = lengths[i // cells] / cells
        mass[i : i + 2] += density * length / 2
        springs.append((i, i + 1 if i + 1 < 2 * cells else -1, stiff / length))
    return damped(setup, chain(springs, list(mass[:-1])))


@pytest.mark.parametrize("changes", [{}, {"added_mass": 5.035}, {"pulley_inertia": 1e-9}], ids=str)
def test_its_frequency_is_that_of_two_rods_and_the_pulley(changes: dict[str, float]) -> None:
    setup = smooth(**changes)
    assert free_vibration(NAME, setup) == pytest.approx(two_rods(setup), rel=1e-3)


def test_weight_fibre_rig_rings_at_its_frequency() -> None:
    setup = hanging()
    out = run(NAME, setup, *held(0.5), start=Start(u=-1e-4))
    natural = math.sqrt(setup.fibre_stiffness / (setup.mass + setup.fibre_mass / 3)) / (2 * math.pi)
    found = frequency(out[:, 0], float(out[-100:, 0].mean()), 6)
    assert found == pytest.approx(natural * math.sqrt(1 - 0.0736**2), rel=1e-3)


def test_at_rest_the_gauge_shows_the_weight() -> None:
    out = run(NAME, smooth(), *held(1.5))
    assert out[-1, 2] == pytest.approx(smooth().rest_tension, abs=smooth().fibre_mass * 9.81)
    assert abs(out[-1, 0]) < 5e-6


def test_it_agrees_with_the_force_model_on_taut_motion() -> None:
    """Both leave the arc out; what is left is the fibre's mass: 1e-4 of the range of u."""
    x, w = sine(1.0, 0.03, 1.0)
    one, two = run("force", nominal(), x, w), run(NAME, nominal(), x, w)
    assert np.abs(one[:, 0] - two[:, 0]).max() < 1e-4 * np.ptp(one[:, 0])


def test_it_goes_through_slack_and_snatch() -> None:
    out = run(NAME, nominal(), *trapezoid(2.0, 0.035, 2.0, 0.125))
    assert out[:, 2].max() > 100.0
    assert out[:, 0].max() < 0.4


def test_halving_the_step_quarters_the_error() -> None:
    x, w = sine(0.5, 0.03, 2.0)
    fine = run(NAME, smooth(), x, w, {"step": DT / 32})
    errors = [np.abs(run(NAME, smooth(), x, w, {"step": DT / k})[:, 0] - fine[:, 0]).max() for k in (1, 2, 4)]
    assert np.all(np.log2(np.array(errors[:-1]) / np.array(errors[1:])) > 1.7), errors


def test_a_run_in_two_blocks_is_the_run_in_one_bit_for_bit() -> None:
    chosen = model(NAME)
    x, w = trapezoid(0.3, 0.03, 2.0, 0.125)
    drive, out, parts = np.stack([x, w], axis=1), np.empty((len(x) - 1, 3)), np.empty((len(x) - 1, 3))
    c = chosen.constants(nominal(), {})
    chosen.advance(c, chosen.start(c, Start()), drive, DT, out)
    state = chosen.start(c, Start())
    for a in range(0, len(x) - 1, 20):
        b = min(a + 20, len(x) - 1)
        chosen.advance(c, state, np.ascontiguousarray(drive[a : b + 1]), DT, parts[a:b])
    assert np.array_equal(out, parts)
