"""Short windows of recordings, restarted from the measured state, as a least-squares problem.

Each window's start (u, v, s, s') is free within the reconstruction's error and eliminated window by window; the
wanted parameters are common to all. Windows that a model cannot follow (impacts) count less (Cauchy weights).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError
from stand.recording import Recording
from stand.setup import System
from twin.compare.measured import Measured, measured
from twin.fit.unknown import Unknown, applied
from twin.model import FibreModel, Start
from twin.score.windows import HALF, WINDOW, next_start, reconstruct

Float = NDArray[np.float64]

#: one sigma of a reconstructed start: u m, v m/s, s m, s' m/s
PRIOR = np.array([7.5e-6, 7.5e-3, 15e-6, 30e-3])
#: least noise believed of u (m) and F (N)
FLOOR = (2e-6, 0.02)
#: windows used at most; more cost time and add little
MOST = 60


@dataclass(frozen=True)
class Window:
    """Samples [at, at + span] of one recording."""

    data: Measured
    at: int
    span: int

    @property
    def noise(self) -> tuple[float, float]:
        """One sigma of u and F."""
        return max(self.data.noise[0], FLOOR[0]), max(self.data.noise[1], FLOOR[1])


def windows(recordings: Sequence[Recording]) -> tuple[Window, ...]:
    """At most MOST windows spread over all recordings; InputError where no stretch is taut enough to start in."""
    found = [window for recording in recordings for window in _windows(measured(recording))]
    if not found:
        raise InputError("no taut stretch to restart in", where="recordings", remedy="Record a slower or longer run")
    keep = np.unique(np.linspace(0, len(found) - 1, min(MOST, len(found))).round().astype(int))
    return tuple(found[i] for i in keep)


def _windows(data: Measured) -> list[Window]:
    span, found = round(WINDOW / data.dt), []
    moving = np.flatnonzero(np.abs(data.u - data.u[0]) > 10 * max(data.noise[0], FLOOR[0]))
    first = max(data.begin, int(moving[0]) - span if len(moving) else 0, 2 * HALF)
    for begin in range(first, len(data.u) - 2 * span, span):
        at = next_start(data.F, begin, begin + span)
        if at is not None:
            found.append(Window(data, at, span))
    return found


def residual(model: FibreModel, window: Window, chosen: Sequence[Unknown], values: Float, shift: Float) -> Float:
    """(simulated - measured) / noise over the window, u then F [2 span]; shift: of the start, [4]."""
    data, at, span = window.data, window.at, window.span
    setup, own = applied(data.setup, chosen, values)
    start = _shifted(reconstruct(setup, data.drive, data.u, data.F, at, data.dt), shift)
    constants = model.constants(setup, own)
    state, out = model.start(constants, start), np.empty((span, 3))
    if model.advance(constants, state, np.ascontiguousarray(data.drive[at : at + span + 1]), data.dt, out) != 0:
        return np.full(2 * span, 1e3)
    part = slice(at + 1, at + span + 1)
    noise = window.noise
    return np.concatenate([(out[:, 0] - data.u[part]) / noise[0], (out[:, 2] - data.F[part]) / noise[1]])


def _shifted(start: Start, shift: Float) -> Start:
    u, v, s, rim = (float(part) for part in shift)
    moved = dataclasses.replace(start, u=start.u + u, v=start.v + v)
    if start.s is None or start.rim_speed is None:
        return moved
    return dataclasses.replace(moved, s=start.s + s, rim_speed=start.rim_speed + rim)


@dataclass
class Projected:
    """One window's residual and its derivative over the parameters with the start eliminated, and the best start."""

    residual: Float
    slope: Float
    shift: Float


def project(model: FibreModel, window: Window, chosen: Sequence[Unknown], values: Float, shift: Float) -> Projected:
    """Linearise one window at `values` and `shift`."""
    r = residual(model, window, chosen, values, shift)
    slope = np.empty((len(r), len(chosen)))
    for i, unknown in enumerate(chosen):
        moved = values.copy()
        moved[i] += unknown.step if values[i] + unknown.step <= unknown.bounds[1] else -unknown.step
        slope[:, i] = (residual(model, window, chosen, moved, shift) - r) / (moved[i] - values[i])
    free = 4 if window.data.setup.system is System.WFPD else 2
    start = np.zeros((len(r), free))
    for j in range(free):
        moved = shift.copy()
        moved[j] += 0.2 * PRIOR[j]
        start[:, j] = residual(model, window, chosen, values, moved) - r
    start /= 0.2  # per prior sigma
    inverse = np.linalg.inv(start.T @ start + np.eye(free))
    pull = inverse @ (start.T @ r + shift[:free] / PRIOR[:free])
    best = shift.copy()
    best[:free] -= PRIOR[:free] * np.clip(pull, -3.0, 3.0)
    remove = start @ (inverse @ (start.T @ np.column_stack([r, slope])))
    return Projected(r - remove[:, 0], slope - remove[:, 1:], best)
