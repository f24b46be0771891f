"""By how much a simulation is late: the shift at which R is largest, to a fraction of a sample."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

#: shifts that are looked at, s either way
REACH = 0.1
#: below this R no shift means anything
LEAST_R = 0.2


def best_lag(measured: Float, simulated: Float, dt: float, reach: float = REACH) -> float:
    """The lag of `simulated` behind `measured` in s (above 0: late), within +-reach; NaN where no R reaches 0.2.

    R at every whole shift over the samples that both share, then the vertex of the parabola through the best three.
    """
    most = min(round(reach / dt), len(measured) // 4)
    return best_shift(correlation(measured, simulated, most)) * dt


def best_shift(curve: Float) -> float:
    """Samples from the middle of a curve of R [2 most + 1] to the vertex of the parabola through its best three; NaN
    where no R reaches 0.2.
    """
    if not np.any(curve > LEAST_R):
        return math.nan
    at = int(np.nanargmax(curve))
    return at - len(curve) // 2 + _vertex(curve, at)


def _vertex(curve: Float, at: int) -> float:
    if not 0 < at < len(curve) - 1:
        return 0.0
    before, here, after = curve[at - 1 : at + 2]
    bend = before - 2.0 * here + after
    return float(0.5 * (before - after) / bend) if np.isfinite(bend) and bend < 0.0 else 0.0


def correlation(measured: Float, simulated: Float, most: int) -> Float:
    """R of measured[i] with simulated[i + k] for k = -most..most, each over its own overlap: [2 most + 1]."""
    n = len(measured)
    a, b = measured - measured.mean(), simulated - simulated.mean()
    size = 1 << (n + most).bit_length()
    spectrum = np.conj(np.fft.rfft(a, size)) * np.fft.rfft(b, size)
    cross = np.roll(np.fft.irfft(spectrum, size), most)[: 2 * most + 1]
    k = np.arange(-most, most + 1)
    count = n - np.abs(k)
    low, high = np.maximum(0, -k), np.minimum(n, n - k)
    sa, saa = _span(a, low, high), _span(a * a, low, high)
    sb, sbb = _span(b, low + k, high + k), _span(b * b, low + k, high + k)
    scale = np.maximum(saa - sa**2 / count, 0.0) * np.maximum(sbb - sb**2 / count, 0.0)
    floor = 1e-24 * max(float(np.sum(a * a)) * float(np.sum(b * b)), 1e-300)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(scale > floor, (cross - sa * sb / count) / np.sqrt(scale), np.nan)


def _span(values: Float, low: NDArray[np.int_], high: NDArray[np.int_]) -> Float:
    """Sums of values[low:high] for many spans."""
    total = np.concatenate(([0.0], np.cumsum(values)))
    return np.asarray(total[high] - total[low])
