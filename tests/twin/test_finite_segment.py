"""The finite-segment model against the rod on bristles, the capstan, statics and the other fibres."""

from __future__ import annotations

import math

import numpy as np
import pytest

from stand.setup import nominal
from tests.twin.fibre_runs import (
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
from twin.model import Start

NAME = "finite-segment"


@pytest.mark.slow
def test_many_segments_vibrate_as_a_rod_on_the_rims_bristles() -> None:
    fine = {"segments": 190, "fine_segments": 160, "bending_stiffness": 1e-6}
    expected = foundation_frequency(smooth(), 1e8, 3e7)
    assert free_vibration(NAME, smooth(), fine, 3) == pytest.approx(expected, rel=1e-3)


def test_the_default_keeps_the_frequency_to_two_hundredths() -> None:
    expected = foundation_frequency(smooth(), 1e8, 3e7)
    assert free_vibration(NAME, smooth(), cycles=3) == pytest.approx(expected, rel=2e-2)


def test_weight_fibre_rig_rings_at_its_frequency() -> None:
    setup = hanging()
    out = run(NAME, setup, *held(0.4), start=Start(u=-1e-4))
    natural = math.sqrt(setup.fibre_stiffness / (setup.mass + setup.fibre_mass / 3)) / (2 * math.pi)
    found = frequency(out[:, 0], float(out[-100:, 0].mean()), 5)
    assert found == pytest.approx(natural * math.sqrt(1 - 0.0736**2), rel=1e-3)


def test_at_rest_the_gauge_shows_the_weight() -> None:
    out = run(NAME, smooth(), *held(0.3))
    assert out[-1, 2] == pytest.approx(smooth().rest_tension, abs=smooth().fibre_mass * 9.81)
    assert np.abs(out[:, 0]).max() < 5e-6


@pytest.mark.slow
def test_a_locked_pulley_slips_at_the_capstan_ratio() -> None:
    x, w = pull(0.01, 0.02)
    setup = smooth(pulley_inertia=1e9)
    ratio = run(NAME, setup, x, w)[-1, 2] / setup.rest_tension
    assert ratio == pytest.approx(math.exp(0.3 * setup.wrap_angle), rel=3e-2)


def test_it_agrees_with_the_point_masses_on_taut_motion() -> None:
    """Modelling error: compliance of rim and bristles, corners between segments; 0.3 % of the range of u."""
    x, w = sine(0.5, 0.03, 1.0)
    one, two = run("point-mass", nominal(), x, w), run(NAME, nominal(), x, w)
    assert np.abs(one[:, 0] - two[:, 0]).max() < 3e-3 * np.ptp(one[:, 0])


def test_it_goes_through_slack_and_snatch() -> None:
    out = run(NAME, nominal(), *trapezoid(0.4, 0.03, 2.0, 0.125))
    assert out[:, 2].max() > 60.0


def test_the_tangent_is_the_derivative_of_the_balance() -> None:
    from twin.kernels import fibre_segment

    chosen, rng, g = model(NAME), np.random.default_rng(1), 7e-5
    c = chosen.constants(nominal(), {"segments": 20, "fine_segments": 14})
    state = chosen.start(c, Start())
    n = 62
    q = np.concatenate([state[:1], state[2 : n + 1]])
    v = 1e-3 * rng.normal(size=n)
    base, inner = q - g * v, state[3 * n :] + 1e-5

    def balance(speed, mode=0):  # type: ignore[no-untyped-def]
        r, band, border, z = np.zeros(n), np.zeros((n + 5, 11)), np.zeros((2, n)), np.zeros_like(inner)
        a, at = (speed - v) / g, base + g * speed
        fibre_segment.assemble(mode, c, g, 0.0, 0.0, at, speed, a, inner, z, r, band, border)
        return r, band, border

    _, band, border = balance(v, 1)
    for j in range(n):
        step = np.eye(n)[j] * 1e-6
        column = (balance(v + step)[0] - balance(v - step)[0]) / 2e-6
        for i in range(n):
            entry = border[0, i] if j == n - 1 else border[1, j] if i == n - 1 else 0.0
            if i < n - 1 and j < n - 1 and abs(i - j) <= 5:
                entry = band[i, 5 + j - i]
            assert entry == pytest.approx(column[i], abs=0.02, rel=1e-4), (i, j)
