"""The point-mass chain against what the physics must give."""

from __future__ import annotations

import math

import numpy as np
import pytest

from stand.setup import System, nominal
from tests.twin.fibre_runs import (
    DT,
    free_vibration,
    frequency,
    hanging,
    held,
    model,
    point_mass_frequency,
    pull,
    run,
    sine,
    smooth,
    trapezoid,
)
from twin.model import Start

NAME = "point-mass"


@pytest.mark.parametrize(
    "changes", [{}, {"added_mass": 5.035}, {"pulley_inertia": 1e9}, {"pulley_inertia": 1e-9}], ids=str
)
def test_its_frequency_is_that_of_its_springs_and_masses(changes: dict[str, float]) -> None:
    setup = smooth(**changes)
    assert free_vibration(NAME, setup) == pytest.approx(point_mass_frequency(setup), rel=1e-3)


def test_frictionless_it_carries_the_arc_and_ignores_the_pulley() -> None:
    found = free_vibration(NAME, smooth(), {"pulley_friction": 0.0})
    assert found == pytest.approx(point_mass_frequency(smooth(), friction=False), rel=1e-3)
    assert found == pytest.approx(16.19, rel=2e-3)


def test_weight_fibre_rig_rings_at_its_frequency_and_damping() -> None:
    setup = hanging()
    out = run(NAME, setup, *held(1.0), start=Start(u=-1e-4))
    u = out[:, 0] - out[-200:, 0].mean()
    mass = setup.mass + setup.fibre_mass / 3
    natural, ratio = math.sqrt(setup.fibre_stiffness / mass), 0.0736
    assert frequency(u, 0.0, 6) == pytest.approx(natural * math.sqrt(1 - ratio**2) / (2 * math.pi), rel=1e-3)
    peaks = [u[i] for i in range(1, 400) if u[i] > u[i - 1] and u[i] >= u[i + 1] and u[i] > 0]
    decrement = math.log(peaks[0] / peaks[3]) / 3
    assert decrement / math.sqrt(4 * math.pi**2 + decrement**2) == pytest.approx(ratio, rel=2e-2)


@pytest.mark.parametrize("added", [0.0, 5.035])
def test_at_rest_the_gauge_shows_the_weight_and_the_fibre_below_it(added: float) -> None:
    setup = smooth(added_mass=added)
    out = run(NAME, setup, *held(1.5))
    drop = setup.fibre_mass * setup.gravity  # at most the fibre's own weight
    assert out[-1, 2] == pytest.approx(setup.rest_tension, abs=drop)
    assert abs(out[-1, 0]) < 1e-5


@pytest.mark.parametrize("added", [0.0, 5.035])
def test_pulled_slowly_over_the_pulley_the_force_ripples_by_less_than_a_tenth_of_a_newton(added: float) -> None:
    out = run(NAME, smooth(added_mass=added), *pull(0.09, 0.03))
    assert np.ptp(out[3000:, 2]) < 0.1


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_locked_pulley_slips_at_the_capstan_ratio(sign: float) -> None:
    x, w = pull(0.01, 0.01)
    setup = smooth(pulley_inertia=1e9)
    ratio = run(NAME, setup, sign * x, sign * w)[-1, 2] / setup.rest_tension
    assert ratio == pytest.approx(math.exp(sign * 0.3 * setup.wrap_angle), rel=3e-3)


def test_slack_and_snatch_end_at_rest_on_the_pulley() -> None:
    x, w = trapezoid(3.0, 0.035, 2.0, 0.125)
    x[-2000:], w[-2000:] = x[-2000], 0.0
    out = run(NAME, nominal(), x, w)
    assert np.mean(out[:, 2] == 0.0) > 0.2
    assert out[:, 2].max() > 100.0
    assert out[-1, 2] == pytest.approx(nominal().rest_tension, abs=nominal().guide_friction + 0.05)
    assert out[-1, 0] == pytest.approx(x[-1], abs=2e-4)


def test_it_releases_and_catches_the_weight_of_the_weight_fibre_rig() -> None:
    setup = nominal(System.WF).with_values(incline_angle=math.radians(45.0), guide_friction=2.45)
    out = run(NAME, setup, *held(1.5), start=Start(u=0.02, force=0.0))
    fall = setup.gravity * math.sin(setup.incline_angle) - setup.guide_friction / setup.mass
    caught = np.flatnonzero(out[:, 2] > 40)[0]
    assert (caught + 1) * DT == pytest.approx(math.sqrt(2 * 0.02 / fall), rel=0.02)
    time = np.arange(1, 151) * DT
    slow = setup.guide_friction / setup.mass * 0.002 / fall * (np.log(2) / fall)  # what the tanh costs at the start
    assert np.abs(out[:150, 0] - (0.02 - 0.5 * fall * time**2)).max() < 2e-4 + slow
    assert out[:, 2].max() > 200.0
    assert abs(out[-1, 0]) < 1e-4


def test_without_damping_it_loses_only_what_the_method_takes() -> None:
    """SDIRK2 at h damps a mode by |R(i w h)| a step; the bound is that of the lowest mode, twice over."""
    setup = hanging(fibre_damping=0.0)
    out = run(NAME, setup, *held(2.0), start=Start(u=-1e-4))
    z, gamma = 1j * 2 * math.pi * 29.17 * DT, 1 - 1 / math.sqrt(2)
    kept = abs((1 + (1 - 2 * gamma) * z) / (1 - gamma * z) ** 2) ** len(out)
    energy = 0.5 * setup.mass * out[:, 1] ** 2 + 0.5 * setup.fibre_stiffness * (out[:, 0] - out[:, 0].mean()) ** 2
    first, last = energy[:400].max(), energy[-400:].max()
    assert kept**4 - 0.01 < last / first <= 1.0 + 1e-3


def test_halving_the_step_quarters_the_error() -> None:
    x, w = sine(0.5, 0.03, 2.0)
    fine = run(NAME, smooth(), x, w, {"step": DT / 32})
    errors = [np.abs(run(NAME, smooth(), x, w, {"step": DT / k})[:, 0] - fine[:, 0]).max() for k in (1, 2, 4)]
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert np.all(orders > 1.7), errors


def test_halving_the_segments_halves_the_error() -> None:
    """Frequency of a fibre a tenth as heavy as its weight; masses at the segments' ends lump at first order."""
    setup, found = hanging(fibre_mass=0.3), []
    for masses in (3, 7, 15, 31):
        out = run(NAME, setup, *held(0.3), {"masses": masses, "order": 4}, Start(u=-1e-4))
        found.append(frequency(out[:, 0], float(out[-100:, 0].mean()), 5))
    steps = np.abs(np.diff(found))
    assert np.log2(steps[:-1] / steps[1:]) == pytest.approx([1.0, 1.0], abs=0.15)


def test_the_method_of_order_four_leaves_a_thousandth_of_the_error() -> None:
    x, w = sine(0.2, 0.03, 2.0)
    fine = run(NAME, smooth(), x, w, {"order": 4, "pulley_friction": 0.0, "step": DT / 8})[:, 0]
    two, four = (run(NAME, smooth(), x, w, {"order": n, "pulley_friction": 0.0})[:, 0] for n in (2, 4))
    assert np.abs(four - fine).max() < 1e-3 * np.abs(two - fine).max()


def test_a_run_in_two_blocks_is_the_run_in_one_bit_for_bit() -> None:
    chosen = model(NAME)
    x, w = trapezoid(0.6, 0.03, 2.0, 0.125)
    drive, out, parts = np.stack([x, w], axis=1), np.empty((len(x) - 1, 3)), np.empty((len(x) - 1, 3))
    c = chosen.constants(nominal(), {})
    chosen.advance(c, chosen.start(c, Start()), drive, DT, out)
    state = chosen.start(c, Start())
    for a in range(0, len(x) - 1, 20):
        b = min(a + 20, len(x) - 1)
        chosen.advance(c, state, np.ascontiguousarray(drive[a : b + 1]), DT, parts[a:b])
    assert np.array_equal(out, parts)


def test_the_tangent_is_the_derivative_of_the_balance() -> None:
    from twin.kernels import fibre_chain

    chosen, rng, g = model(NAME), np.random.default_rng(1), 1.4e-4
    c = chosen.constants(nominal(), {})
    for x in (0.0, 0.12, 0.15):
        state = chosen.start(c, Start(u=x, x=x))
        q = np.concatenate([state[:1], state[2:17]])
        v = np.concatenate([state[1:2], state[17:32]]) + 1e-3 * rng.normal(size=16)
        base = q - g * v

        def balance(speed, mode=0, base=base, v=v, state=state, x=x):  # type: ignore[no-untyped-def]
            r, band, border, z = np.zeros(16), np.zeros((19, 7)), np.zeros((2, 16)), np.zeros(2)
            a = (speed - v) / g
            fibre_chain.assemble(mode, c, g, x, 0.0, base + g * speed, speed, a, state[48:], z, r, band, border)
            return r, band, border

        _, band, border = balance(v, 1)
        for j in range(16):
            step = np.eye(16)[j] * 1e-6
            column = (balance(v + step)[0] - balance(v - step)[0]) / 2e-6
            for i in range(16):
                entry = border[0, i] if j == 15 else border[1, j] if i == 15 else 0.0
                if i < 15 and j < 15 and abs(i - j) <= 3:
                    entry = band[i, 3 + j - i]
                assert entry == pytest.approx(column[i], abs=1.0)


def test_the_work_of_drive_and_gravity_is_what_is_stored_and_lost() -> None:
    """Taut, frictionless guide: work in = kinetic + elastic + lost in the fibre, to a share that falls with h^2."""
    setup, off = smooth(), []
    for k in (1, 2):
        dt = DT / k
        x, w = sine(0.5, 0.03, 2.0, dt)
        out = run(NAME, setup, x, w, {"pulley_friction": 0.0, "step": dt}, dt=dt)
        speed, pull = np.concatenate([[0.0], out[:, 1]]), np.concatenate([[setup.rest_tension], out[:, 2]])
        drive = float(np.sum(0.5 * (pull[1:] * w[1:] + pull[:-1] * w[:-1])) * dt)
        gravity = -setup.rest_tension * out[-1, 0]
        kinetic = 0.5 * setup.mass * speed[-1] ** 2
        arc = setup.pulley_radius * setup.wrap_angle
        stiffness = setup.fibre_stiffness * setup.free_length / (setup.free_length + arc)
        elastic = 0.5 * (out[-1, 2] ** 2 - setup.rest_tension**2) / stiffness
        damping = setup.fibre_damping * setup.free_length / (setup.free_length + arc)
        lost = float(np.sum(damping * (w[1:] - speed[1:]) ** 2) * dt)
        off.append(abs(drive + gravity - kinetic - elastic - lost))
    fibre = setup.fibre_mass * (9.81 * 0.03 + 0.5 * 0.4**2)  # J: what the fibre's own mass can hold
    assert off[0] < fibre
    assert off[1] < fibre
