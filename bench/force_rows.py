"""Rows of the force model: against real time, Exudyn, MuJoCo and SciPy, and many runs at once."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from importlib.util import find_spec

import numpy as np

from bench import force
from bench.force import DT, SECONDS, SETUP, Float
from bench.row import Row, row

#: drive of the taut peers, and error that all are held to, as a share of u's range
OMEGA, AMPLITUDE, TAUT_ERROR = 2 * math.pi * 0.35, 0.025, 1e-8
#: the snatching drive of the peers, its corners on samples: m/s^2, s of acceleration and of a ramp, Hz, s of rest
ACCELERATION, PULSE, RAMP, FREQUENCY, REST, SNATCH_ERROR = 6.0, 0.05, 0.15, 2.0, 1.0, 2e-4


def rows() -> Iterator[Row]:
    """All of them, as they come."""
    for name, cases, tolerance in (("taut", force.taut, 5e-9), ("snatch", force.snatching, 1e-13)):
        found = force.single(cases(), tolerance, 0)
        note = f"median of 20: {found['ms']:.2f} ms, worst error {found['worst_refined']:.1e}"
        yield row(f"force, {name}, 10 s", "real time", 1e4 / found["ms"], found["error_refined"], note)
    yield from taut_peers()
    yield snatch_peer()
    for name, cases, tolerance, goal in (("taut", force.taut, 1e-6, 1500), ("snatch", force.snatching, 1e-12, 400)):
        found = force.many(cases(), tolerance)
        rate, off = found["runs_per_second"], found["error_refined"]
        yield row(f"many force runs, {name}", f"{goal} runs/s", rate / goal, off, f"{rate:.0f} runs/s")


def taut_peers() -> Iterator[Row]:
    """Exudyn, MuJoCo and SciPy, each at the cheapest setting that meets TAUT_ERROR."""
    from bench import linear_force as linear

    grid = np.arange(round(SECONDS / DT) + 1) * DT
    x, w = AMPLITUDE * (1 - np.cos(OMEGA * grid)), AMPLITUDE * OMEGA * np.sin(OMEGA * grid)
    drive = np.column_stack((x, w))
    out, seconds = force.run(drive, 5e-9)
    mine = _off(out[:, 0], force.refined(drive))
    free = SETUP.with_values(guide_friction=0.0)  # what the two multibody codes solve
    smooth, (ours, fast) = force.run(drive, 1e-15, setup=free)[0][:, 0], force.run(drive, 5e-9, setup=free)
    alike = fast, _off(ours[:, 0], smooth), seconds
    tried: dict[str, list[tuple[str, Callable[[], tuple[Float, float]]]]] = {"exudyn": [], "mujoco": []}
    for solver in linear.SOLVERS:
        for part in (0.5, 1, 2, 4, 8, 16):
            label = f"{solver}, {1e6 * DT / part:.0f} us"
            tried["exudyn"].append((label, _exudyn(solver, DT / part)))
    for parts in (1, 2, 4, 8):
        label = f"RK4, {1e6 * DT / parts:.0f} us"
        tried["mujoco"].append((label, lambda p=parts: linear.mujoco(SETUP, AMPLITUDE, OMEGA, SECONDS, DT, p)))  # type: ignore[misc]
    for peer, settings in tried.items():
        yield _fastest(peer, settings, grid[1:], smooth, *alike)
    yield _scipy_taut(grid, drive, seconds, mine)


def _exudyn(solver: str, step: float) -> Callable[[], tuple[Float, float]]:
    from bench import linear_force as linear

    return lambda: linear.exudyn(SETUP, AMPLITUDE, OMEGA, SECONDS, step, solver)


def _fastest(
    peer: str,
    settings: list[tuple[str, Callable[[], tuple[Float, float]]]],
    grid: Float,
    truth: Float,
    ours: float,
    mine: float,
    rubbing: float,
) -> Row:
    if find_spec(peer) is None:
        return row("force, taut", peer, None, None, f"{peer} is not installed: `make bench` brings it")
    best = ("none", math.inf, math.inf)
    for label, solve in settings:
        data, seconds = solve()
        off = _off(np.interp(grid, data[:, 0], data[:, 1]), truth)
        if off <= TAUT_ERROR and seconds < best[1]:
            best = (label, seconds, off)
    note = f"{best[0]}: {best[1]:.3f} s at {best[2]:.1e}, both without the guide's friction; {ours * 1e3:.2f} ms, "
    note += f"with it {rubbing * 1e3:.2f} ms"
    return row("force, taut", peer, best[1] / ours, mine, note)


def _scipy_taut(grid: Float, drive: Float, ours: float, mine: float) -> Row:
    from bench import scipy_force

    def solve(method: str, rtol: float) -> Float:
        return scipy_force.taut(SETUP, scipy_force.sine(AMPLITUDE, OMEGA), grid, method, rtol)

    truth = force.run(drive, 1e-15)[0][:, 0]
    setting, seconds, off = scipy_force.best(solve, truth, TAUT_ERROR, ("LSODA",))
    return row("force, taut", "scipy LSODA", seconds / ours, mine, f"{setting}: {seconds:.2f} s at {off:.1e}")


def pieces(table: Float) -> Iterator[tuple[float, float, Callable[[float], tuple[float, float]]]]:
    """The snatching drive's stretches of constant acceleration: begin, end, x and x' over time."""
    edges, t = [0.0, REST], REST
    while t < SECONDS:
        edges += [t + PULSE, t + RAMP - PULSE, t + RAMP, t + 0.5 / FREQUENCY]
        t += 0.5 / FREQUENCY
    edges = [*(e for e in edges if e < SECONDS - 1e-9), SECONDS]
    for begin, end in itertools.pairwise(edges):
        (x, v), w = table[round(begin / DT)], table[round(end / DT), 1]
        yield begin, end, _piece(float(x), float(v), float(w - v) / (end - begin) if begin >= REST else 0.0, begin)


def _piece(x: float, v: float, a: float, begin: float) -> Callable[[float], tuple[float, float]]:
    return lambda t: (x + (t - begin) * (v + 0.5 * a * (t - begin)), v + a * (t - begin))


def snatch_peer() -> Row:
    """The best of SciPy's solvers from located switch to located switch, at the same error over 10 s."""
    from bench import scipy_force

    table = force.trapezoid(ACCELERATION * PULSE * (RAMP - PULSE), FREQUENCY, ACCELERATION, RAMP, REST)
    truth = force.refined(table)
    out, seconds = force.run(table, 1e-13)
    mine = _off(out[:, 0], truth)

    def solve(method: str, rtol: float) -> Float:
        return scipy_force.snatch(SETUP, pieces(table), DT, method, rtol)

    setting, theirs, off = scipy_force.best(solve, truth, SNATCH_ERROR, ("DOP853", "LSODA", "RK45"), 9)
    note = f"{setting}: {theirs:.1f} s at {off:.1e}; slack {100 * float(np.mean(out[:, 2] == 0.0)):.0f} % of the time"
    return row("force, snatch", "best of scipy", theirs / seconds, mine, note)


def _off(u: Float, truth: Float) -> float:
    return float(np.abs(u - truth).max() / np.ptp(truth))
