"""The papers' criterion: psi(p) = (1 - R(p))^2 of free runs from the rest (S1 eq. 3), u's and F's added."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stand.recording import Recording
from twin.compare.measured import Measured, measured
from twin.fit.solve import Progress, Solution
from twin.fit.unknown import Unknown, applied
from twin.model import FibreModel
from twin.score.channel import psi

Float = NDArray[np.float64]


def tune(model: FibreModel, recordings: Sequence[Recording], chosen: Sequence[Unknown], tell: Progress) -> Solution:
    """Minimise the sum of psi by a simplex within the bounds; after a snatch this surface is rough."""
    from scipy.optimize import minimize

    data = [measured(recording) for recording in recordings]
    first = np.array([u.value for u in chosen])
    scale = np.array([abs(u.value) or u.step for u in chosen])
    most = 60 * len(chosen)
    count = [0]

    def total(p: Float) -> float:
        count[0] += 1
        tell(f"run {count[0]}", min(count[0] / most, 0.99))
        return sum(sum(_psi(model, d, chosen, first + scale * p)) for d in data)

    bounds = [((u.bounds[0] - v) / s, (u.bounds[1] - v) / s) for u, v, s in zip(chosen, first, scale, strict=True)]
    simplex = np.vstack([np.zeros(len(chosen)), 0.1 * np.eye(len(chosen))])
    options = {"maxfev": most, "xatol": 1e-4, "fatol": 1e-12, "initial_simplex": simplex}
    found = minimize(total, np.zeros(len(chosen)), method="Nelder-Mead", bounds=bounds, options=options)
    values: Float = np.asarray(first + scale * found.x, dtype=np.float64)
    covariance = sum((_information(model, d, chosen, values) for d in data), np.zeros((len(chosen),) * 2))
    return Solution(values, np.asarray(np.linalg.pinv(covariance)), total(np.zeros(len(chosen))), float(found.fun))


def _run(model: FibreModel, data: Measured, chosen: Sequence[Unknown], values: Float) -> Float | None:
    setup, own = applied(data.setup, chosen, values)
    constants = model.constants(setup, own)
    drive = np.ascontiguousarray(data.drive[data.begin :])
    out = np.empty((len(drive) - 1, 3))
    return out if model.advance(constants, model.start(constants, data.start), drive, data.dt, out) == 0 else None


def _psi(model: FibreModel, data: Measured, chosen: Sequence[Unknown], values: Float) -> tuple[float, float]:
    out = _run(model, data, chosen, values)
    if out is None:
        return 4.0, 4.0
    part = slice(data.begin + 1, None)
    return psi(data.u[part], out[:, 0]), psi(data.F[part], out[:, 2])


def _information(model: FibreModel, data: Measured, chosen: Sequence[Unknown], values: Float) -> Float:
    """Inverse covariance from u's free-run residual, its half-second blocks taken as independent."""
    base = _run(model, data, chosen, values)
    if base is None:
        return np.zeros((len(chosen), len(chosen)))
    slope = np.empty((len(base), len(chosen)))
    for i, unknown in enumerate(chosen):
        moved = values.copy()
        moved[i] += unknown.step
        out = _run(model, data, chosen, moved)
        slope[:, i] = 0.0 if out is None else (out[:, 0] - base[:, 0]) / unknown.step
    r = base[:, 0] - data.u[data.begin + 1 :]
    block = max(1, round(0.5 / data.dt))
    rows = range(0, len(r), block)
    spread = sum(np.outer(g, g) for g in (slope[a : a + block].T @ r[a : a + block] for a in rows))
    matrix = slope.T @ slope
    return matrix @ np.linalg.pinv(np.asarray(spread) + 1e-30 * np.eye(len(chosen))) @ matrix
