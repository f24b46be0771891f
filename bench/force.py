"""Figures of the force kernel alone: `python -m bench.force` prints each with its error beside it.

Errors are shares of u's range over the whole 10 s, against the same equations by SciPy's DOP853 between located
switches at rtol 1e-13 (`--reference N` cases of each kind, half a minute each), and, for every case, against the
kernel itself on a grid refined four times with its series run to rounding.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

import twin.models
from stand.setup import Setup, nominal
from twin.model import FibreModel, Start
from twin.plugins import load

Float = NDArray[np.float64]
DT, SECONDS, CASES = 5e-4, 10.0, 20
FORCE = load(twin.models, "force", FibreModel)
SETUP = nominal()


def trapezoid(stroke: float, frequency: float, acceleration: float, ramp: float, begin: float) -> Float:
    """x and x' [n, 2] of holds joined by ramps of bounded acceleration, at rest before `begin`."""
    time = np.arange(round(SECONDS / DT) + 1) * DT - begin
    half, pulse = 0.5 / frequency, (ramp - math.sqrt(ramp**2 - 4.0 * stroke / acceleration)) / 2.0
    turn, r = np.divmod(np.maximum(time, 0.0), half)
    top = acceleration * pulse
    v = np.clip(np.minimum(acceleration * r, acceleration * (ramp - r)), 0.0, top)
    left = np.maximum(0.0, ramp - r)
    middle = 0.5 * acceleration * pulse**2 + top * (r - pulse)
    s = np.where(r < pulse, 0.5 * acceleration * r * r, middle)
    s = np.where(left < pulse, stroke - 0.5 * acceleration * left**2, s)
    down = turn % 2 == 1
    return np.column_stack((np.where(down, stroke - s, s), np.where(down, -v, v)))


def snatching() -> Iterator[Float]:
    """Twenty 2 Hz trapezoids of 35 mm and 6 m/s^2 (the shortest ramps) that begin at different instants of a sample."""
    for i in range(CASES):
        yield trapezoid(0.035, 2.0, 6.0, 2.0001 * math.sqrt(0.035 / 6.0), 1.0 + 2.5e-5 * i)


def taut() -> Iterator[Float]:
    """Twenty sinusoids of 50 to 88 mm at 0.35 to 0.54 Hz, which keep the fibre taut."""
    time = np.arange(round(SECONDS / DT) + 1) * DT
    for i in range(CASES):
        w, a = 2.0 * math.pi * (0.35 + 0.01 * i), 0.025 + 0.001 * i
        yield np.column_stack((a * (1.0 - np.cos(w * time)), a * w * np.sin(w * time)))


def run(table: Float, tolerance: float, dt: float = DT, setup: Setup = SETUP) -> tuple[Float, float]:
    """u, u', F and s of computing, the least of three."""
    k = FORCE.constants(setup, {"tolerance": tolerance})
    out, times = np.empty((len(table) - 1, 3)), []
    for _ in range(3):
        state, began = FORCE.start(k, Start()), time.perf_counter()
        status = FORCE.advance(k, state, table, dt, out)
        times.append(time.perf_counter() - began)
        if status:
            raise RuntimeError(f"status {status}")
    return out, min(times)


def refined(table: Float, parts: int = 4) -> Float:
    """u from the same cubic Hermite motion on a grid `parts` times finer."""
    p = np.arange(parts) / parts
    x0, w0, x1, w1 = (c[:, None] for c in (table[:-1, 0], table[:-1, 1] * DT, table[1:, 0], table[1:, 1] * DT))
    a2, a3 = 3 * (x1 - x0) - 2 * w0 - w1, w0 + w1 - 2 * (x1 - x0)
    x, w = x0 + p * (w0 + p * (a2 + p * a3)), (w0 + p * (2 * a2 + 3 * p * a3)) / DT
    fine = np.vstack((np.column_stack((x.ravel(), w.ravel())), table[-1:]))
    return run(fine, 1e-17, DT / parts)[0][parts - 1 :: parts, 0]


def scipy_u(table: Float) -> Float:
    """u by DOP853 between located switches."""
    from tests.twin.reference import Reference

    return Reference(SETUP).run(table, rtol=1e-13)[:, 0]


def single(cases: Iterator[Float], tolerance: float, references: int) -> dict[str, Any]:
    """Median time in ms and errors as shares of u's range."""
    times, errors, against = [], [], []
    for i, table in enumerate(cases):
        out, seconds = run(table, tolerance)
        span = float(np.ptp(out[:, 0]))
        times.append(seconds * 1e3)
        errors.append(float(np.abs(out[:, 0] - refined(table)).max()) / span)
        if i < references:
            against.append(float(np.abs(out[:, 0] - scipy_u(table)).max()) / span)
    row = {"ms": median(times), "error_refined": median(errors), "worst_refined": max(errors)}
    return row | ({"error_scipy": median(against)} if against else {})


def many(cases: Iterator[Float], tolerance: float, runs: int = 240) -> dict[str, Any]:
    """Ten-second runs a second on all cores, and their error."""
    from twin.kernels.force_batch import advance_many

    drives = np.array(list(cases))
    drives = drives[np.arange(runs) % len(drives)]
    k = np.tile(FORCE.constants(SETUP, {"tolerance": tolerance}), (runs, 1))
    states = np.array([FORCE.start(k[0], Start())] * runs)
    out, best = np.empty((runs, drives.shape[1] - 1, 3)), math.inf
    for _ in range(3):
        began = time.perf_counter()
        status = advance_many(k, states.copy(), drives, DT, out)
        best = min(best, time.perf_counter() - began)
        if status.any():
            raise RuntimeError(f"status {status.max()}")
    errors = [float(np.abs(out[i, :, 0] - refined(drives[i])).max() / np.ptp(out[i, :, 0])) for i in range(CASES)]
    return {"runs_per_second": runs / best, "error_refined": median(errors), "cores": os.cpu_count()}


def streaming(samples: int = 7_200_000, block: int = 20) -> dict[str, Any]:
    """ns a sample of R in blocks, the call included, and its error after an hour at 2 kHz."""
    from twin.score.stream import StreamR

    rng, t = np.random.default_rng(1), np.arange(samples) * DT
    a = 0.2 + 0.03 * np.sin(4 * np.pi * t) + 1e-5 * rng.standard_normal(samples)
    b = a + 1e-3 * rng.standard_normal(samples)
    blocks, stream = list(zip(a.reshape(-1, block), b.reshape(-1, block), strict=True)), StreamR()
    began = time.perf_counter()
    for measured, simulated in blocks:
        stream.push(measured, simulated)
    seconds = time.perf_counter() - began
    p, q = a.astype(np.longdouble), b.astype(np.longdouble)
    p, q = p - p.mean(), q - q.mean()
    exact = (p * q).sum() / np.sqrt((p * p).sum() * (q * q).sum())
    return {"ns_per_sample": seconds / samples * 1e9, "error": abs(float(exact - np.longdouble(stream.R)))}


def main() -> None:
    """Prints the table and, with --json, writes it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--reference", type=int, default=0, metavar="N", help="cases of each kind checked by SciPy")
    parser.add_argument("--json", type=Path, help="file for the rows")
    options = parser.parse_args()
    FORCE.warm()
    rows = {
        "force, taut, 10 s (<= 2 ms, 1e-8)": single(taut(), 1e-8, options.reference),
        "force, snatch, 10 s (<= 10 ms, 2e-4; goal 5 ms)": single(snatching(), 1e-13, options.reference),
        "many runs, taut at 1e-6 (>= 1500/s)": many(taut(), 1e-6),
        "many runs, snatch at 2e-4 (>= 400/s)": many(snatching(), 1e-12),
        "streaming R, blocks of 20 (<= 150 ns, goal 50; 1e-12)": streaming(),
    }
    for job, row in rows.items():
        print(f"{job:55s}", "  ".join(f"{name} {value:.3g}" for name, value in row.items()))
    if options.json:
        options.json.parent.mkdir(parents=True, exist_ok=True)
        options.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
