"""The lag over a whole run, from running sums: each block costs the same, however long the run has been."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from twin.score.lag import REACH, best_shift

Float = NDArray[np.float64]


class StreamLag:
    """R of measured[i] with simulated[i + k] for every shift k within +-reach, over all i whose partners have come."""

    def __init__(self, dt: float, reach: float = REACH) -> None:
        self._dt, self._most = dt, round(reach / dt)
        shifts = 2 * self._most + 1
        self._count, self._a, self._aa = 0, 0.0, 0.0
        self._b, self._bb, self._ab = np.zeros(shifts), np.zeros(shifts), np.zeros(shifts)
        self._first: tuple[float, float] | None = None
        self._measured, self._simulated = np.empty(0), np.empty(0)

    def push(self, measured: Float, simulated: Float) -> None:
        """Takes a block, [n] each. Sums are taken about the first sample, so that they keep their digits."""
        if self._first is None and len(measured):
            self._first = float(measured[0]), float(simulated[0])
        if self._first is None:
            return
        a = np.concatenate((self._measured, measured - self._first[0]))
        b = np.concatenate((self._simulated, simulated - self._first[1]))
        new = len(a) - 2 * self._most
        if new > 0:
            self._add(a[self._most : self._most + new], b, new)
        self._measured, self._simulated = a[-2 * self._most :], b[-2 * self._most :]

    def _add(self, a: Float, b: Float, new: int) -> None:
        self._count += new
        self._a += float(a.sum())
        self._aa += float(a @ a)
        self._ab += np.correlate(b, a, "valid")
        self._b += _spans(b, new)
        self._bb += _spans(b * b, new)

    @property
    def lag(self) -> float:
        """s, above 0 where the simulation is late: the vertex of the parabola through the best three shifts.

        NaN where no R reaches 0.2.
        """
        if self._count == 0:
            return math.nan
        n = self._count
        spread = max(self._aa - self._a**2 / n, 0.0) * np.maximum(self._bb - self._b**2 / n, 0.0)
        with np.errstate(invalid="ignore", divide="ignore"):
            floor = 1e-24 * max(self._aa * float(self._bb.max()), 1e-300)
            curve = np.where(spread > floor, (self._ab - self._a * self._b / n) / np.sqrt(spread), np.nan)
        return best_shift(curve) * self._dt


def _spans(values: Float, length: int) -> Float:
    """Sums over every stretch of `length` values."""
    total = np.concatenate(([0.0], np.cumsum(values)))
    spans: Float = total[length:] - total[:-length]
    return spans
