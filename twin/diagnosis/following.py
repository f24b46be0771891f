"""The next experiment: within the stand's limits, the excitation on which the leading rivals' predictions differ
most.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stand.setup import System
from twin.diagnosis.fit import Fitted
from twin.diagnosis.rivals import Standing
from twin.diagnosis.search import Search
from twin.kernels import composed
from twin.kernels import composed_slots as k

Float = NDArray[np.float64]
MASS = 5.035
SPEED, ACCELERATION = 1.0, 12.0
#: within the limits of the drive and, bouncing, of the guide: shape, Hz, peak-to-peak stroke m, ramp s, added mass kg
CANDIDATES = (
    ("trapezoidal", 0.25, 0.06, 0.8, 0.0),
    ("trapezoidal", 1.25, 0.03, 0.20, 0.0),
    ("trapezoidal", 1.6, 0.035, 0.17, 0.0),
    ("trapezoidal", 2.0, 0.025, 0.13, 0.0),
    ("trapezoidal", 1.25, 0.03, 0.20, MASS),
    ("quasi-sinusoidal", 0.35, 0.08, 0.0, 0.0),
    ("quasi-sinusoidal", 1.0, 0.05, 0.0, MASS),
)


def following(search: Search, ranks: Sequence[Standing]) -> dict[str, Any] | None:
    """verdict.md's `next_experiment`; None on a rig that has no drive to order."""
    if search.problem.system is not System.WFPD:
        return None
    for rank in ranks:
        if rank.alike:
            other = rank.fits[rank.alike[0]]
            gaps = [_difference(search, other, c) for c in CANDIDATES]
            best = int(np.argmax(gaps))
            why = f"there {rank.name} and {rank.alike[0]} differ by {gaps[best]:.1f} times the sensors' noise"
            return _told(CANDIDATES[best], why, [rank.name.split("/")[0], rank.alike[0].split("/")[0]])
    return _unreached(search)


def _unreached(search: Search) -> dict[str, Any]:
    """Nothing to tell apart: what the runs did not reach yet."""
    runs = search.problem.runs
    speed = max(float(np.abs(r.u.rate).max()) for r in runs)
    if speed < 0.7:
        why = (
            f"no run is faster than {speed:.2f} m/s: what begins above that speed (0.4 m/s is published) can't be seen"
        )
        return _told(CANDIDATES[3], why, ["velocity-dependent-damping", "velocity-dependent-stiffness"])
    if all(r.setup.added_mass == 0 for r in runs):
        why = (
            "no run has the added mass: load alone tells the pulley's friction from the guide's, a gain from the weight"
        )
        return _told(CANDIDATES[4], why, ["pulley-bearing-friction", "guide-coulomb-friction"])
    why = "a slow run tells friction's own shape and creep from what grows with speed"
    return _told(CANDIDATES[0], why, ["guide-stribeck-friction", "guide-viscous-drag"])


def _told(candidate: tuple[str, float, float, float, float], why: str, separates: list[str]) -> dict[str, Any]:
    shape, frequency, amplitude, ramp, mass = candidate
    order = {
        "shape": shape, "frequency": frequency, "amplitude": amplitude, "ramp": ramp,
        "cycles": max(3, round(8 * frequency)), "added_mass": mass,
    }  # fmt: skip
    return {"why": why, "separates": separates, "excitation": order}


def motion(candidate: tuple[str, float, float, float, float], dt: float, seconds: float = 2.5) -> Float:
    """x, x' [n, 2] of a candidate, smooth enough for a servo."""
    shape, frequency, amplitude, ramp, _ = candidate
    time = np.arange(round(seconds / dt)) * dt
    if shape == "trapezoidal":
        phase = (time * frequency) % 1.0
        up = np.clip(phase / (ramp * frequency), 0, 1)
        down = np.clip((phase - 0.5) / (ramp * frequency), 0, 1)
        x = amplitude * (_s(up) - _s(down))
    else:
        x = 0.5 * amplitude * (1 - np.cos(2 * math.pi * frequency * time))
    return np.ascontiguousarray(np.column_stack([x, np.gradient(x, dt)]))


def _s(t: Float) -> Float:
    smooth: Float = t**3 * (10 - 15 * t + 6 * t * t)
    return smooth


def _difference(search: Search, other: Fitted, candidate: tuple[str, float, float, float, float]) -> float:
    """Rms difference of two models in noise units over windows of 0.1 s that begin alike."""
    run = search.problem.runs[0]
    dt, drive = run.dt, motion(candidate, run.dt)
    first = _windows(search.current, candidate, drive, np.zeros((1, 4)), np.array([2]), len(drive) - 8, dt)[0]
    length = round(0.1 / dt)
    begins = np.arange(2, len(drive) - length - 8, length)
    w = np.gradient(first[:, 4], dt)
    starts = np.column_stack([first[begins - 2, 0], first[begins - 2, 1], first[begins - 2, 4], w[begins - 2]])
    pair = [_windows(f, candidate, drive, starts, begins, length, dt) for f in (search.current, other)]
    gap = pair[0] - pair[1]
    squares = [
        np.nanmean(np.minimum(np.abs(gap[..., c]) / n, 1e3) ** 2) for c, n in ((0, run.noise_u), (2, run.noise_F))
    ]
    return float(np.sqrt(max(squares)))


def _windows(
    fitted: Fitted,
    candidate: tuple[str, float, float, float, float],
    drive: Float,
    starts: Float,
    first: Any,
    length: int,
    dt: float,
) -> Float:
    """The true signals and what the gauges make of them (in places 0 and 2)."""
    from twin.kernels import composed_sense

    model, n = fitted.model, len(first)
    setup = model.setup(fitted.z, 0).with_values(added_mass=candidate[4])
    constants = model.constants(fitted.z, [setup.rest_tension] * len(model.setups))[:1]
    constants[0, [k.K_MASS, k.K_WEIGHT, k.K_REST]] = setup.mass, setup.rest_tension, setup.rest_tension
    moved = drive.copy()
    x, speed = np.ascontiguousarray(moved[:, 0]), np.ascontiguousarray(moved[:, 1])
    moves = model.hooks(fitted.z, "moves")
    composed_sense.drive_end(x, speed, dt, moves.address, moves.p)
    moved = np.ascontiguousarray(np.column_stack([x, speed]))
    before, after, senses = (model.hooks(fitted.z, kind) for kind in ("before", "after", "senses"))
    out, status, zero = np.empty((n, length, 5)), np.zeros(n, np.int64), np.zeros(n, np.int64)
    composed.windows(
        np.ascontiguousarray(starts), np.zeros((n, k.STATES)), constants, zero, np.asarray(first, np.int64), length,
        moved, dt, before.address, before.p, after.address, after.p, np.zeros(1, np.int64), out, status,
    )  # fmt: skip
    told = np.empty((n, length, 2))
    composed_sense.sense(out, zero, np.asarray(first, np.int64), dt, 0.0, 0.0, senses.address, senses.p, told)
    out[..., 0], out[..., 2] = told[..., 0], told[..., 1]
    return out
