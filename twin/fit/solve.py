"""Gauss-Newton over the windows with Cauchy weights, bounds and a sandwich covariance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.fit.unknown import Unknown
from twin.fit.windows import Window, project, residual
from twin.model import FibreModel

Float = NDArray[np.float64]
Progress = Callable[[str, float], None]

ROUNDS = 8
#: a change below this share of its own uncertainty ends the search
ENOUGH = 0.02
#: the data hold a parameter only this weakly (in its relative size): it runs free beyond
LOOSE = 3.0


@dataclass(frozen=True)
class Solution:
    """values, covariance, and the mean square residual per sample before and after (robust, in noise units)."""

    values: Float
    covariance: Float
    before: float
    after: float


def solve(model: FibreModel, all_windows: Sequence[Window], chosen: Sequence[Unknown], tell: Progress) -> Solution:
    """Tune `chosen` to the windows."""
    values = np.array([u.value for u in chosen])
    scale = np.array([abs(u.value) or u.step for u in chosen])
    shifts = [np.zeros(4) for _ in all_windows]
    before, covariance = np.nan, np.eye(len(chosen))
    for turn in range(ROUNDS):
        tell(f"round {turn + 1}", turn / ROUNDS)
        parts = [project(model, w, chosen, values, s) for w, s in zip(all_windows, shifts, strict=True)]
        cost = np.array([float(np.mean(p.residual**2)) for p in parts])
        weight = 1.0 / (1.0 + cost / (4.0 * np.median(cost)))
        before = _mean(cost) if turn == 0 else before
        change, covariance = _step([(p.slope * scale, p.residual) for p in parts], weight)
        values = _bounded(values + _damped(change) * scale, chosen)
        shifts = [p.shift for p in parts]
        if np.all(np.abs(change) < ENOUGH * np.sqrt(np.diag(covariance)) + 1e-9):
            break
    last = [residual(model, w, chosen, values, s) for w, s in zip(all_windows, shifts, strict=True)]
    after = _mean(np.array([float(np.mean(r**2)) for r in last]))
    return Solution(values, covariance * np.outer(scale, scale), before, after)


def _mean(cost: Float) -> float:
    return float(np.median(cost))


def _step(parts: Sequence[tuple[Float, Float]], weight: Float) -> tuple[Float, Float]:
    """The Gauss-Newton step and the sandwich covariance, each window one draw."""
    n = parts[0][0].shape[1]
    matrix, gradient, spread = np.eye(n) / LOOSE**2, np.zeros(n), np.zeros((n, n))
    for (slope, r), w in zip(parts, weight, strict=True):
        pull = w * slope.T @ r
        matrix += w * slope.T @ slope
        gradient += pull
        spread += np.outer(pull, pull)
    inverse = np.linalg.inv(matrix)
    return -inverse @ gradient, inverse @ (spread + np.eye(n) / LOOSE**2) @ inverse + 1e-3 * inverse


def _damped(change: Float) -> Float:
    """At most half of the value at once."""
    return change * min(1.0, 0.5 / max(float(np.abs(change).max()), 1e-300))


def _bounded(values: Float, chosen: Sequence[Unknown]) -> Float:
    return np.clip(values, [u.bounds[0] for u in chosen], [u.bounds[1] for u in chosen])
