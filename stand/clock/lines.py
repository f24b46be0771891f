"""Straight lines under and between points: the geometry that a clock fit comes down to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Line:
    """value = intercept + slope * k. margin: least distance to the points, negative where no line fits between."""

    intercept: float
    slope: float
    margin: float = 0.0

    def at(self, k: Float | float) -> Float:
        """The line's values."""
        return np.asarray(self.intercept + self.slope * np.asarray(k, dtype=np.float64))


def lower_hull(k: Float, y: Float) -> NDArray[np.int64]:
    """Indices of the lower convex hull of points sorted by k (Andrew's monotone chain)."""
    ks, ys = k.tolist(), y.tolist()
    hull: list[int] = []
    for i, (ki, yi) in enumerate(zip(ks, ys, strict=True)):
        while hull:
            b = hull[-1]
            if ks[b] == ki:
                if ys[b] <= yi:
                    break
                hull.pop()
                continue
            if len(hull) < 2:
                break
            a = hull[-2]
            if (ys[b] - ys[a]) * (ki - ks[a]) < (yi - ys[a]) * (ks[b] - ks[a]):
                break
            hull.pop()
        if not hull or ks[hull[-1]] != ki:
            hull.append(i)
    return np.array(hull, dtype=np.int64)


def line_below(k: Float, y: Float, slope: float) -> Line:
    """The line below all points with the least sum of distances: the hull's edge over the mean of k.

    A linear programme (Moon, Skelly, Towsley 1999, for network clocks) whose optimum is that edge. Coordinates
    are reduced by `slope` first, so that rounding doesn't matter. margin: the mean distance to the points.
    """
    centre = float(np.mean(k))
    base = float(np.min(y))
    kc, yc = k - centre, (y - base) - slope * (k - centre)
    hull = lower_hull(kc, yc)
    right = int(np.searchsorted(kc[hull], 0.0))
    if len(hull) < 2 or right == 0 or right == len(hull):
        low = int(np.argmin(yc))
        tilt, level = 0.0, float(yc[low])
    else:
        a, b = hull[right - 1], hull[right]
        tilt = float((yc[b] - yc[a]) / (kc[b] - kc[a]))
        level = float(yc[a] - tilt * kc[a])
    margin = float(np.mean(yc) - level)
    total = slope + tilt
    return Line(base + level - total * centre, total, margin)


def line_between(k_low: Float, low: Float, k_high: Float, high: Float, slope: float, spread: float = 2e-3) -> Line:
    """The line above points (k_low, low) and below (k_high, high) that stays farthest from both.

    Largest margin over slopes within `spread` (relative) of `slope`; the margin as a function of the slope is concave,
    so a golden-section search over the hulls' corners finds it. Negative where no line passes between.
    """
    centre = (float(np.mean(k_low)) + float(np.mean(k_high))) / 2
    base = float(np.min(high))
    hk, hy = k_high - centre, (high - base) - slope * (k_high - centre)
    lk, ly = k_low - centre, (low - base) - slope * (k_low - centre)
    upper, lower = lower_hull(hk, hy), lower_hull(lk, -ly)
    hk, hy, lk, ly = hk[upper], hy[upper], lk[lower], ly[lower]

    def ends(tilt: float) -> tuple[float, float]:
        return float(np.min(hy - tilt * hk)), float(np.max(ly - tilt * lk))

    tilt = _golden(lambda t: ends(t)[0] - ends(t)[1], -spread * slope, spread * slope)
    top, bottom = ends(tilt)
    total = slope + tilt
    return Line(base + (top + bottom) / 2 - total * centre, total, (top - bottom) / 2)


def _golden(value: Callable[[float], float], low: float, high: float) -> float:
    """The place of a concave function's maximum."""
    ratio = 0.6180339887498949
    a, b = high - ratio * (high - low), low + ratio * (high - low)
    fa, fb = value(a), value(b)
    for _ in range(44):
        if fa < fb:
            low, a, fa = a, b, fb
            b = low + ratio * (high - low)
            fb = value(b)
        else:
            high, b, fb = b, a, fa
            a = high - ratio * (high - low)
            fa = value(a)
    return (low + high) / 2
