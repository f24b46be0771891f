"""The friction laws: what each says at rest, while sliding and over a cycle, and LuGre's published case."""

from __future__ import annotations

import numpy as np
import pytest

import twin.friction
from stand.errors import InputError
from twin.friction import FrictionLaw
from twin.friction.table import pack_curve
from twin.plugins import every, load

LAWS = [law.name for law in every(twin.friction, FrictionLaw)]


def law(name: str) -> FrictionLaw:
    return load(twin.friction, name, FrictionLaw)


def cycle(name: str, rate: float, **values: float) -> tuple[np.ndarray, np.ndarray]:
    """Friction over two slow cycles of 2 mm amplitude; inner states stepped by the midpoint rule."""
    chosen = law(name)
    force, slope = chosen.load()
    p, z, out = chosen.pack(values), 0.0, []
    time = np.linspace(0.0, 2.0 / rate, 20_001)
    speed = 2e-3 * 2 * np.pi * rate * np.sin(2 * np.pi * rate * time)
    dt = time[1] - time[0]
    for v in speed:
        out.append(force(v, z, 0.0, p))
        middle = z + 0.5 * dt * slope(v, z, p)
        z += dt * slope(v, middle, p)
    return speed, np.array(out)


@pytest.mark.parametrize("name", LAWS)
def test_a_law_opposes_the_motion_and_dissipates_over_a_cycle(name: str) -> None:
    speed, friction = cycle(name, 0.1)
    second = slice(len(speed) // 2, None)
    assert np.mean(speed[second] * friction[second]) > 0
    fast = np.abs(speed) > 0.8 * np.abs(speed).max()
    if name not in ("lugre", "dahl"):
        assert np.all(friction[fast] * speed[fast] > 0)


@pytest.mark.parametrize("name", LAWS)
def test_every_law_states_its_source_and_refuses_unknown_parameters(name: str) -> None:
    assert law(name).source.author
    force, rate = law(name).load()
    assert np.isfinite(force(0.01, 0.0, 0.0, law(name).pack({})))
    assert rate(0.0, 0.0, law(name).pack({})) == 0.0
    if name != "table":
        with pytest.raises(InputError, match="unknown parameter"):
            law(name).pack({"nonsense": 1.0})


def test_coulomb_with_stick_answers_what_is_applied_until_it_breaks_away() -> None:
    stick = law("coulomb-with-stick")
    force, _ = stick.load()
    p = stick.pack({"coulomb": 3.0, "static": 4.0})
    assert force(0.0, 0.0, 2.5, p) == 2.5
    assert force(0.0, 0.0, -7.0, p) == -4.0
    assert force(0.2, 0.0, -7.0, p) == 3.0


def test_dahl_is_independent_of_rate_and_lugre_reaches_its_steady_curve() -> None:
    _, slow = cycle("dahl", 0.1)
    _, fast = cycle("dahl", 10.0)
    assert np.abs(slow - fast).max() < 1e-9
    force, rate = law("lugre").load()
    p = law("lugre").pack({})
    z, v = 0.0, 2e-3
    for _ in range(20_000):
        z += 1e-5 * rate(v, z, p)
    steady = 1.0 + 0.5 * np.exp(-((v / 1e-3) ** 2)) + 0.4 * v
    assert force(v, z, 0.0, p) == pytest.approx(steady, rel=1e-9)


def test_a_table_is_linear_between_its_points_and_constant_beyond() -> None:
    force, _ = law("table").load()
    curve = np.array([[-0.1, -3.0], [0.0, 0.5], [0.1, 3.0]])
    p = pack_curve(curve)
    speeds = np.linspace(-0.3, 0.3, 61)
    assert np.allclose([force(v, 0.0, 0.0, p) for v in speeds], np.interp(speeds, *curve.T), atol=1e-15)
    with pytest.raises(InputError, match="rising"):
        pack_curve(curve[::-1])


def test_lugre_gives_the_published_stick_slip_case_to_its_digits() -> None:
    """m = 1, k = 2 pulled at 0.1 m/s from rest (Canudas de Wit et al., section III.C): x(25 s)."""
    from scipy.integrate import solve_ivp

    force, rate = law("lugre").load()
    p = law("lugre").pack({})

    def motion(t: float, y: np.ndarray) -> list[float]:
        pull = 2.0 * (0.1 * t - y[0])
        return [y[1], pull - force(y[1], y[2], pull, p), rate(y[1], y[2], p)]

    end = solve_ivp(motion, (0.0, 25.0), [0.0, 0.0, 0.0], method="LSODA", rtol=1e-12, atol=1e-15, max_step=0.05).y[
        0, -1
    ]
    assert end == pytest.approx(1.908839199226, abs=2e-10)
