"""Figures of the discretised fibres: error, time against real time, against Exudyn, over the number of elements."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from importlib.util import find_spec
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

import twin.models
from bench.force import DT, snatching
from stand.setup import Setup, nominal
from twin.model import FibreModel, Start
from twin.plugins import load

Float = NDArray[np.float64]
Row = dict[str, Any]
AMPLITUDE, OMEGA = 0.015, 2 * math.pi


def taut(seconds: float) -> Float:
    """x and x' [n, 2] of a quasi-sinusoid of 30 mm at 1 Hz, 0.6 m/s^2."""
    t = np.arange(round(seconds / DT) + 1) * DT
    return np.column_stack((AMPLITUDE * (1 - np.cos(OMEGA * t)), AMPLITUDE * OMEGA * np.sin(OMEGA * t)))


def run(name: str, setup: Setup, drive: Float, parameters: Mapping[str, float], repeat: int = 3) -> tuple[Float, float]:
    """u, u', F and the least seconds of computing; RuntimeError with the status where the model gave up."""
    model = load(twin.models, name, FibreModel)
    c = model.constants(setup, parameters)
    first, out, times = model.start(c, Start()), np.empty((len(drive) - 1, 3)), []
    for _ in range(repeat):
        state, began = first.copy(), time.perf_counter()
        status = model.advance(c, state, drive, DT, out)
        times.append(time.perf_counter() - began)
        if status:
            raise RuntimeError(f"{name}: status {status}")
    return out, min(times)


def error(name: str, setup: Setup, drive: Float, parameters: Mapping[str, float], out: Float) -> float:
    """Largest error of u as a share of its range, against steps sixteen times smaller."""
    fine, _ = run(name, setup, drive, {**parameters, "step": DT / 16}, 1)
    return float(np.abs(out[:, 0] - fine[:, 0]).max() / np.ptp(fine[:, 0]))


def row(job: str, peer: str, ratio: float | None, found: float | None, note: str = "") -> Row:
    """One line of the table; ratio: times faster than the peer."""
    return {"job": job, "peer": peer, "ratio": ratio, "error": found, "note": note}


def point_mass() -> Iterator[Row]:
    """Taut against real time and Exudyn; slack and snatch against real time."""
    drive, setup = taut(10.0), nominal()
    out, seconds = run("point-mass", setup, drive, {})
    yield row("point mass 7, taut", "real time", 10.0 / seconds, error("point-mass", setup, drive, {}, out))
    yield against_exudyn()
    times, slack = [], []
    for case in list(snatching())[:5]:
        out, seconds = run("point-mass", setup, case, {}, 2)
        times.append(10.0 / seconds)
        slack.append(float(np.mean(out[:, 2] == 0.0)))
    note = f"no failed run of 5; slack {100 * median(slack):.0f} % of the time; least {min(times):.0f}x"
    yield row("point mass 7, slack and snatch", "real time", median(times), window_error("point-mass"), note)


def window_error(name: str) -> float:
    """Error of u over the first tenth of a second of slack and snatch, as a share of u's range (chaos comes later)."""
    case = next(iter(snatching()))
    part = np.ascontiguousarray(case[: round(1.6 / DT)])
    out, _ = run(name, nominal(), part, {}, 1)
    slack = np.flatnonzero(out[:, 2] < 0.5)
    end = int(slack[0]) + round(0.1 / DT)
    return error(name, nominal(), np.ascontiguousarray(part[: end + 1]), {}, out[:end])


def against_exudyn() -> Row:
    """The same frictionless chain in both, Exudyn at the step that gives our error."""
    job, peer = "point mass 7, taut, frictionless", "exudyn"
    if find_spec("exudyn") is None:
        return row(job, peer, None, None, "exudyn is not installed: `make bench` brings it")
    from bench.exudyn_chain import solve

    setup, parameters, seconds = nominal().with_values(guide_friction=0.0), {"pulley_friction": 0.0}, 4.0
    drive = taut(seconds)
    ours, computing = run("point-mass", setup, drive, parameters)
    fine, _ = run("point-mass", setup, drive, {**parameters, "step": DT / 32}, 1)
    mine = float(np.abs(ours[:, 0] - fine[:, 0]).max() / np.ptp(fine[:, 0]))
    model = load(twin.models, "point-mass", FibreModel)
    c = model.constants(setup, parameters)
    nodes, grid = model.start(c, Start())[2:16].reshape(-1, 2), np.arange(1, len(drive)) * DT
    found, theirs, step = math.inf, math.inf, 2 * DT
    while found > mine and step > DT / 16:
        step /= 2
        data, theirs = solve(c, nodes, AMPLITUDE, OMEGA, seconds, step)
        found = float(np.abs(np.interp(grid, data[:, 0], data[:, 1]) - fine[:, 0]).max() / np.ptp(fine[:, 0]))
    note = f"exudyn {found:.1e} at {step * 1e6:.0f} us, {seconds / theirs:.0f}x real time"
    return row(job, peer, theirs / computing, mine, note)


def ancf() -> Iterator[Row]:
    """Taut and snatch against real time, and the cost over the number of elements."""
    setup, drive = nominal(), taut(2.0)
    out, seconds = run("ancf", setup, drive, {})
    yield row("ANCF 18, taut", "real time", 2.0 / seconds, error("ancf", setup, drive, {}, out))
    case = np.ascontiguousarray(next(iter(snatching()))[: round(4.0 / DT) + 1])
    out, seconds = run("ancf", setup, case, {}, 1)
    note = f"slack {100 * float(np.mean(out[:, 2] < 0.5)):.0f} % of the time"
    yield row("ANCF 18, slack and snatch", "real time", 4.0 / seconds, window_error("ancf"), note)
    costs, errors = {}, math.nan
    for elements in (18, 36, 72, 144):
        own = {"elements": elements, "fine_elements": round(elements * 14 / 18)}
        part = np.ascontiguousarray(drive[:1001])
        out, seconds = run("ancf", setup, part, own, 2)
        costs[elements] = 1e6 * seconds / len(out) / elements
        errors = error("ancf", setup, part, own, out) if elements == 144 else errors
    spread = ", ".join(f"{n}: {cost:.1f}" for n, cost in costs.items())
    ratio = DT * 1e6 / (costs[144] * 144)
    yield row("ANCF 144, taut", "real time", ratio, errors, f"us per sample and element: {spread}")


def fresh(measure: Callable[[str], float]) -> Iterator[Row]:
    """A fresh process, cache warm, to its first result; ratio: one second over what it takes."""
    for name in ("force", "point-mass", "ancf"):
        seconds = measure(name)
        yield row(f"fresh process, {name}", "1 s", 1.0 / seconds, None, f"{seconds:.2f} s; no error applies")
