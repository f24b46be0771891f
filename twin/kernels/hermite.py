"""Slopes for the cubic Hermite interpolation of a measured drive position."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

#: samples after one that its slope needs
LOOKAHEAD = 2


def slopes(x: Float, dt: float) -> Float:
    """x' at uniform samples, m/s [n]: slope of the least-squares parabola through five of them.

    Its error is 0.57 x''' dt^2 (0.06 mm/s at the drive's jerk limit); noise of sigma in x gives
    0.32 sigma/dt, a third of what the sharpest difference of fourth order gives.
    """
    n = len(x)
    if n < 5:
        return np.gradient(x, dt) if n > 1 else np.zeros(n)
    slope = np.empty(n)
    slope[2:-2] = (2.0 * (x[4:] - x[:-4]) + (x[3:-1] - x[1:-3])) / (10.0 * dt)
    slope[:2] = _end(x[:5], dt)[:2]
    slope[-2:] = _end(x[-5:], dt)[3:]
    return slope


def _end(x: Float, dt: float) -> Float:
    """The parabola's slope at each of five samples."""
    k = np.arange(-2.0, 3.0)
    first, second = (k @ x) / 10.0, ((k**2 - 2.0) @ x) / 14.0
    return np.asarray((first + 2.0 * second * k) / dt)


def drive_table(x: Float, dt: float) -> Float:
    """x and x' at the samples, [n, 2], as a model's `advance` takes them."""
    return np.ascontiguousarray(np.column_stack((x, slopes(x, dt))))
