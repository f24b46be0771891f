"""Figures of the discretised fibres: error, time against real time, against Exudyn, over the number of elements."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping
from statistics import median

import numpy as np
from numpy.typing import NDArray

import twin.models
from bench.force import DT, snatching
from bench.row import Row, row
from stand.setup import Setup, nominal
from twin.model import FibreModel, Start
from twin.plugins import load

Float = NDArray[np.float64]
AMPLITUDE, OMEGA = 0.015, 2 * math.pi
STEP = 2.5e-4  # s, of the ANCF rows


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


def point_mass() -> Iterator[Row]:
    """Taut against real time and Exudyn; slack and snatch against real time."""
    from bench import exudyn_rows

    drive, setup = taut(10.0), nominal()
    out, seconds = run("point-mass", setup, drive, {})
    yield row("point mass 7, taut", "real time", 10.0 / seconds, error("point-mass", setup, drive, {}, out))
    yield from exudyn_rows.point_mass()
    times, slack = [], []
    for case in list(snatching())[:5]:
        out, seconds = run("point-mass", setup, case, {}, 2)
        times.append(10.0 / seconds)
        slack.append(float(np.mean(out[:, 2] == 0.0)))
    note = f"no failed run of 5; slack {100 * median(slack):.0f} % of the time; least {min(times):.0f}x"
    yield row("point mass 7, slack and snatch", "real time", median(times), window_error("point-mass"), note)


def window_error(name: str, parameters: Mapping[str, float] | None = None) -> float:
    """Error of u over the first tenth of a second of slack and snatch, as a share of u's range (chaos comes later)."""
    case = next(iter(snatching()))
    part = np.ascontiguousarray(case[: round(1.6 / DT)])
    own = dict(parameters or {})
    out, _ = run(name, nominal(), part, own, 1)
    slack = np.flatnonzero(out[:, 2] < 0.5)
    end = int(slack[0]) + round(0.1 / DT)
    return error(name, nominal(), np.ascontiguousarray(part[: end + 1]), own, out[:end])


def ancf() -> Iterator[Row]:
    """Taut and snatch against real time at 250 us, Exudyn, and the cost over the number of elements."""
    from bench import exudyn_rows

    setup, drive, fine = nominal(), taut(10.0), {"step": STEP}
    out, seconds = run("ancf", setup, drive, fine)
    found = error("ancf", setup, drive[:4001], fine, out[:4000])
    yield row("ANCF 18 at 250 us, taut", "real time", 10.0 / seconds, found, "error over the first 2 s")
    yield from exudyn_rows.ancf()
    case = next(iter(snatching()))
    out, seconds = run("ancf", setup, case, fine, 2)
    note = f"slack {100 * float(np.mean(out[:, 2] < 0.5)):.0f} % of the time"
    yield row("ANCF 18 at 250 us, slack and snatch", "real time", 10.0 / seconds, window_error("ancf", fine), note)
    yield from elements(setup, np.ascontiguousarray(drive[:2001]))


def elements(setup: Setup, drive: Float) -> Iterator[Row]:
    """Cost per sample and element from 18 to 144 elements, at the model's own step."""
    costs, last = {}, (math.nan, math.nan)
    for count in (18, 36, 72, 144):
        own = {"elements": count, "fine_elements": round(count * 10 / 18)}
        out, seconds = run("ancf", setup, drive, own, 2)
        costs[count] = 1e6 * seconds / len(out) / count
        if count == 144:
            last = (len(out) * DT / seconds, error("ancf", setup, drive[:501], own, out[:500]))
    spread = ", ".join(f"{n}: {cost:.2f}" for n, cost in costs.items())
    yield row("ANCF 144, taut", "real time", *last, f"us per sample and element: {spread}")
    least, most = min(costs.values()), max(costs.values())
    yield row("ANCF, cost over elements", "linear", least / most, last[1], "least over most cost per element")
