"""The force model by SciPy's solvers, each at the loosest tolerance for an error: taut, and from switch to switch.

The balances are written once more in plain Python from S1 eqs. 1 to 3, with what can be worked out beforehand.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from stand.setup import Setup

Float = NDArray[np.float64]
Drive = Callable[[float], tuple[float, float]]
#: s, longest step between switches: a longer one steps over a short slack
LOOK = 1e-3


class Balances:
    """m u'' = T1 - T0 - F(u'), (J/r^2) s'' = T2 - T1, with strands that are taut or not."""

    def __init__(self, setup: Setup) -> None:
        length = setup.free_length
        r1, r2 = length / setup.weight_strand_length, length / setup.drive_strand_length
        self.c1, self.c2 = setup.fibre_stiffness * r1, setup.fibre_stiffness * r2
        self.b1, self.b2 = setup.fibre_damping * r1, setup.fibre_damping * r2
        self.rest, self.m = setup.rest_tension, setup.mass
        self.rim = setup.pulley_inertia / setup.pulley_radius**2
        self.dry, self.vs = setup.guide_friction, setup.guide_friction_velocity

    def tensions(self, y: Float, x: float, w: float) -> tuple[float, float]:
        """T1 and T2 as if both strands were taut, N."""
        return (
            self.rest + self.c1 * (y[2] - y[0]) + self.b1 * (y[3] - y[1]),
            self.rest + self.c2 * (x - y[2]) + self.b2 * (w - y[3]),
        )

    def rates(self, drive: Drive, one: bool = True, two: bool = True) -> Callable[[float, Float], list[float]]:
        """y' for solve_ivp; one, two: the strands that are taut."""
        c1, c2, b1, b2, rest, m, rim, dry, vs = (
            self.c1,
            self.c2,
            self.b1,
            self.b2,
            self.rest,
            self.m,
            self.rim,
            self.dry,
            self.vs,
        )

        def rates(t: float, y: Float) -> list[float]:
            u, v, s, r = y.tolist()
            x, w = drive(t)
            t1 = rest + c1 * (s - u) + b1 * (r - v) if one else 0.0
            t2 = rest + c2 * (x - s) + b2 * (w - r) if two else 0.0
            return [v, (t1 - rest - dry * math.tanh(v / vs)) / m, r, (t2 - t1) / rim]

        return rates


def sine(amplitude: float, omega: float) -> Drive:
    """x and x' of amplitude (1 - cos(omega t))."""
    return lambda t: (amplitude * (1.0 - math.cos(omega * t)), amplitude * omega * math.sin(omega * t))


def taut(setup: Setup, drive: Drive, grid: Float, method: str, rtol: float) -> Float:
    """u [n - 1] at grid[1:]; max_step because the solvers would step over a motion that begins at rest."""
    rates = Balances(setup).rates(drive)
    ends = (0.0, float(grid[-1]))
    return np.asarray(
        solve_ivp(rates, ends, [0.0] * 4, method, grid, rtol=rtol, atol=1e-3 * rtol, max_step=0.02).y[0, 1:]
    )


def snatch(setup: Setup, corners: Iterator[tuple[float, float, Drive]], dt: float, method: str, rtol: float) -> Float:
    """u at every sample: each piece of smooth drive motion (begin, end, drive) solved from switch to switch."""
    balances, y, taut, found = Balances(setup), np.zeros(4), [True, True], []
    for begin, end, drive in corners:
        at = begin
        while at < end - 1e-12:
            last, status, y, values = _stretch(balances, drive, at, end, y, taut, dt, method, rtol)
            found.append(values)
            if status >= 0:
                taut[status] = not taut[status]
            at = last
    return np.concatenate(found)


def _stretch(
    balances: Balances,
    drive: Drive,
    at: float,
    end: float,
    y: Float,
    taut: list[bool],
    dt: float,
    method: str,
    rtol: float,
) -> tuple[float, int, Float, Float]:
    one, two = taut

    def first(t: float, y: Float) -> float:
        tension, _ = balances.tensions(y, *drive(t))
        slack = -(balances.rest / balances.c1 + y[2] - y[0])
        return tension if one else max(slack, -tension / balances.c1)

    def second(t: float, y: Float) -> float:
        x, w = drive(t)
        _, tension = balances.tensions(y, x, w)
        slack = -(balances.rest / balances.c2 + x - y[2])
        return tension if two else max(slack, -tension / balances.c2)

    for event in (first, second):
        event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    grid = np.arange(math.floor(at / dt + 1e-9) + 1, round(end / dt) + 1) * dt
    grid = np.minimum(grid, end)
    found = solve_ivp(
        balances.rates(drive, one, two),
        (at, end),
        y,
        method,
        grid,
        rtol=rtol,
        atol=1e-3 * rtol,
        events=(first, second),
        max_step=LOOK if one and two else 0.5 * LOOK,
    )
    which = next((k for k in (0, 1) if len(found.t_events[k])), -1)
    if which < 0:
        return end, which, np.array(found.y[:, -1]), found.y[0]
    values = np.asarray(found.y[0]) if len(found.t) else np.empty(0)
    return float(found.t_events[which][0]), which, np.array(found.y_events[which][0]), values


def best(
    solve: Callable[[str, float], Float], truth: Float, error: float, methods: Sequence[str], digits: int = 6
) -> tuple[str, float, float]:
    """(method and tolerance, seconds, error) of the fastest solver that keeps u within `error` of its range.

    Each begins with a relative tolerance of 10^-digits.
    """
    found = ("none", math.inf, math.inf)
    for method in methods:
        for rtol in (10.0**-n for n in range(digits, 14)):
            began = time.perf_counter()
            u = solve(method, rtol)
            seconds = time.perf_counter() - began
            off = float(np.abs(u - truth).max() / np.ptp(truth)) if len(u) == len(truth) else math.inf
            if off <= error:
                if seconds < found[1]:
                    found = (f"{method} at {rtol:.0e}", seconds, off)
                break
            if seconds > 2.0 * found[1]:
                break
    return found
