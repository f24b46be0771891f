"""The ANCF cable elements against the elastica, a hanging chain, the capstan and the rig's own frequencies."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from stand.setup import System, nominal
from tests.twin.fibre_runs import (
    DT,
    foundation_frequency,
    free_vibration,
    frequency,
    hanging,
    held,
    model,
    pull,
    run,
    sine,
    smooth,
    trapezoid,
)
from twin.kernels import fibre_ancf_layout as layout
from twin.kernels.fibre_layout import EA, FIBRE_MASS, GX, GY, LENGTH, TAU
from twin.model import Start

Float = NDArray[np.float64]
NAME = "ancf"


class Cable:
    """Elements alone, without rig or pulley: nodes' positions and slopes, static balance by Newton's method."""

    def __init__(self, elements: int, bending: float, axial: float, mass: float = 0.0, gravity: float = 0.0) -> None:
        self.n, self.length = elements, 1.0 / elements
        c = model(NAME).constants(hanging(), {"elements": elements, "bending_stiffness": bending})
        c[EA], c[TAU], c[FIBRE_MASS], c[LENGTH], c[GX], c[GY] = axial, 0.0, mass, 1.0, 0.0, -gravity
        self.c = c
        at = np.linspace(0, 1, elements + 1)
        self.q = np.stack([at, 0 * at, np.ones_like(at), 0 * at], axis=1).reshape(-1)

    def forces(self, q: Float) -> tuple[Float, Float, Float]:
        """Internal forces [4 (n + 1)] at rest, their derivative and the mass matrix."""
        from twin.kernels import fibre_ancf_element

        size, g, none = len(q), 1e3, np.zeros(8)
        f, k, m = np.zeros(size), np.zeros((size, size)), np.zeros((size, size))
        lin, one, two, work = np.empty((12, 4)), np.empty(8), np.empty((8, 8)), np.empty((5, 8))
        fibre_ancf_element.linear(self.c, self.length, g, True, lin)
        for e in range(self.n):
            part = slice(4 * e, 4 * e + 8)
            fibre_ancf_element.element(self.c, self.length, g, True, q[part].copy(), none, none, lin, one, two, work)
            f[part] += one
            mass = np.kron(lin[:4], np.eye(2))
            k[part, part] += (two - mass / g) / g
            m[part, part] += mass
        return f, k, m

    def settle(self, free: Float, load: Float, steps: int = 20) -> None:
        """Balance under `load`, applied in steps; free: the unknowns' numbers."""
        for part in np.linspace(1 / steps, 1, steps):
            for _ in range(60):
                f, k, _ = self.forces(self.q)
                change = np.linalg.solve(k[np.ix_(free, free)], (part * load - f)[free])
                self.q[free] += change * min(1.0, 0.1 / np.abs(change).max())
                if np.abs(change).max() < 1e-10:
                    break


def elastica(load: float) -> tuple[float, float]:
    """Tip of an inextensible cantilever of unit length and stiffness under a dead tip force, by shooting."""
    from scipy.integrate import solve_ivp
    from scipy.optimize import brentq

    def shape(bend: float) -> Float:
        def slope(_s: float, y: Float) -> list[float]:
            return [y[1], -load * math.cos(y[0]), math.cos(y[0]), math.sin(y[0])]

        return solve_ivp(slope, (0, 1), [0.0, bend, 0.0, 0.0], rtol=1e-10, atol=1e-12).y[:, -1]

    end = shape(brentq(lambda bend: shape(bend)[1], 0.0, load))
    return float(end[2]), float(end[3])


@pytest.mark.parametrize("load", [1.0, 4.0, 10.0])
def test_a_cantilever_bends_as_the_elastica(load: float) -> None:
    errors = []
    for elements in (6, 12):
        cable = Cable(elements, 1.0, 1e6)
        push = np.zeros_like(cable.q)
        push[-3] = load
        cable.settle(np.delete(np.arange(2, len(push)), 1), push)  # position and direction of the clamped end are held
        errors.append(math.hypot(*(cable.q[-4:-2] - np.array(elastica(load)))))
    assert errors[1] < 2e-3
    assert errors[1] < 0.4 * errors[0]


def test_a_slack_cable_hangs_as_the_catenary() -> None:
    """Ends at one height, 0.8 of its length apart: sag a (cosh(d/a) - 1) with a sinh(d/a) = 1/2, d = 0.4."""
    from scipy.optimize import brentq

    cable = Cable(16, 1e-6, 1e4, mass=1.0, gravity=9.81)
    at = np.linspace(0, 1, 17)
    sag = 0.28
    cable.q[0::4], cable.q[1::4] = 0.8 * at, -4 * sag * at * (1 - at)
    cable.q[2::4], cable.q[3::4] = 0.8, -4 * sag * (1 - 2 * at)
    size = len(cable.q)
    free = np.setdiff1d(np.arange(size), [0, 1, size - 4, size - 3])
    cable.settle(free, np.zeros(size), steps=1)
    a = brentq(lambda a: a * math.sinh(0.4 / a) - 0.5, 0.1, 10.0)
    assert -cable.q[1::4].min() == pytest.approx(a * (math.cosh(0.4 / a) - 1), rel=5e-3)


def test_a_hanging_chain_swings_as_bessel_says() -> None:
    """Lowest mode of a chain hung at one end: omega = (2.404826 / 2) sqrt(g / L)."""
    cable = Cable(12, 1e-9, 1e5, mass=1.0, gravity=9.81)
    at = np.linspace(0, 1, 13)
    cable.q[0::4], cable.q[1::4], cable.q[2::4], cable.q[3::4] = 0.0, -at, 0.0, -1.0
    free = np.arange(2, len(cable.q))
    cable.settle(free, np.zeros_like(cable.q), steps=1)
    _, k, m = cable.forces(cable.q)
    values = np.linalg.eigvals(np.linalg.solve(m[np.ix_(free, free)], k[np.ix_(free, free)])).real
    assert math.sqrt(min(values)) == pytest.approx(2.404826 / 2 * math.sqrt(9.81), rel=2e-3)


@pytest.mark.parametrize("changes", [{}, {"pulley_inertia": 1e9}], ids=["free", "locked"])
def test_a_soft_fibre_vibrates_as_a_rod_on_the_rims_bristles(changes: dict[str, float]) -> None:
    setup, fine = smooth(**changes), {"elements": 54, "fine_elements": 44, "bending_stiffness": 1e-6}
    assert free_vibration(NAME, setup, fine, 3) == pytest.approx(foundation_frequency(setup, 1e8, 3e7), rel=1e-3)


def test_the_default_mesh_keeps_the_frequency_to_a_hundredth() -> None:
    assert free_vibration(NAME, smooth(), cycles=3) == pytest.approx(foundation_frequency(smooth(), 1e8, 3e7), rel=1e-2)


def test_weight_fibre_rig_rings_at_its_frequency() -> None:
    setup = hanging()
    out = run(NAME, setup, *held(0.4), start=Start(u=-1e-4))
    natural = math.sqrt(setup.fibre_stiffness / (setup.mass + setup.fibre_mass / 3)) / (2 * math.pi)
    found = frequency(out[:, 0], float(out[-100:, 0].mean()), 5)
    assert found == pytest.approx(natural * math.sqrt(1 - 0.0736**2), rel=1e-3)


def test_at_rest_the_gauge_shows_the_weight() -> None:
    out = run(NAME, smooth(), *held(0.4))
    assert out[-1, 2] == pytest.approx(smooth().rest_tension, abs=smooth().fibre_mass * 9.81)
    assert np.abs(out[:, 0]).max() < 5e-6


@pytest.mark.slow
def test_pulled_slowly_over_the_pulley_the_force_ripples_by_less_than_a_tenth_of_a_newton() -> None:
    out = run(NAME, smooth(), *pull(0.09, 0.05))
    assert np.ptp(out[2200:, 2]) < 0.1


@pytest.mark.slow
def test_a_locked_pulley_slips_at_the_capstan_ratio() -> None:
    x, w = pull(0.01, 0.02)
    setup = smooth(pulley_inertia=1e9)
    ratio = run(NAME, setup, x, w)[-1, 2] / setup.rest_tension
    assert ratio == pytest.approx(math.exp(0.3 * setup.wrap_angle), rel=2e-2)


def test_it_goes_through_slack_and_snatch() -> None:
    x, w = trapezoid(0.5, 0.03, 2.0, 0.125)
    out = run(NAME, nominal(), x, w)
    assert np.mean(out[:, 2] < 0.5) > 0.1
    assert out[:, 2].max() > 60.0


def test_it_agrees_with_the_point_masses_on_taut_motion() -> None:
    """Modelling error: compliance of rim, bristles and bond, EI; 0.3 % of the range of u."""
    x, w = sine(1.0, 0.03, 1.0)
    one, two = run("point-mass", nominal(), x, w), run(NAME, nominal(), x, w)
    assert np.abs(one[:, 0] - two[:, 0]).max() < 3e-3 * np.ptp(one[:, 0])


def test_halving_the_step_quarters_the_error() -> None:
    setup = nominal(System.WF).with_values(guide_friction=0.0)
    x, w = held(0.1)
    fine = run(NAME, setup, x, w, {"step": DT / 16}, Start(u=-1e-4))
    errors = []
    for k in (1, 2, 4):
        out = run(NAME, setup, x, w, {"step": DT / k}, Start(u=-1e-4))
        errors.append(np.abs(out[40:, 0] - fine[40:, 0]).max())
    assert np.all(np.log2(np.array(errors[:-1]) / np.array(errors[1:])) > 1.6), errors


def test_without_damping_the_weight_fibre_rig_keeps_its_energy() -> None:
    setup = hanging(fibre_damping=0.0)
    out = run(NAME, setup, *held(0.5), start=Start(u=-1e-4))
    rest = out[:, 0].mean()
    energy = 0.5 * setup.mass * out[:, 1] ** 2 + 0.5 * setup.fibre_stiffness * (out[:, 0] - rest) ** 2
    assert 0.97 < energy[-200:].max() / energy[:200].max() < 1.01


def test_a_run_in_two_blocks_is_the_run_in_one_bit_for_bit() -> None:
    chosen = model(NAME)
    x, w = trapezoid(0.1, 0.03, 2.0, 0.1)
    drive, out, parts = np.stack([x, w], axis=1), np.empty((len(x) - 1, 3)), np.empty((len(x) - 1, 3))
    c = chosen.constants(nominal(), {})
    first = chosen.start(c, Start())
    state = first.copy()
    chosen.advance(c, first, drive, DT, out)
    for a in range(0, len(x) - 1, 20):
        b = min(a + 20, len(x) - 1)
        chosen.advance(c, state, np.ascontiguousarray(drive[a : b + 1]), DT, parts[a:b])
    assert np.array_equal(out, parts)
    assert layout.BAND == 7
