"""Straight lines under and between points: the geometry that a clock fit comes down to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

#: s below which a distance counts as this much where absolutes are weighed
LEAST = 5e-6


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


def line_under(k: Float, y: Float, slope: float, group: int = 24) -> Line:
    """The line under all points whose slope is that of the lowest point in each `group` of them (least absolutes).

    Where few points are nearly as low as they can be, two of them make a worse slope than the many that come close.
    margin: the mean distance to the points.
    """
    start = line_below(k, y, slope)
    rest = y - start.at(k)
    count = len(k) // group
    if count < 4:
        return start
    low = rest[: count * group].reshape(count, group).argmin(axis=1) + group * np.arange(count)
    centre = float(np.mean(k))
    place, height = k[low] - centre, rest[low]
    weight = np.ones(count)
    for _ in range(30):
        tilt, level = np.polyfit(place, height, 1, w=np.sqrt(weight))
        weight = 1 / np.maximum(np.abs(height - level - tilt * place), LEAST)
    rest = rest - tilt * (k - centre)
    under = float(np.min(rest))
    intercept = start.intercept + under - tilt * centre
    return Line(intercept, start.slope + float(tilt), float(np.mean(rest)) - under)


def line_between(k_low: Float, low: Float, k_high: Float, high: Float, slope: float, spread: float = 2e-3) -> Line:
    """The line above points (k_low, low) and below (k_high, high) that stays farthest from both.

    Largest margin over slopes within `spread` (relative) of `slope`; the margin as a function of the slope is concave,
    so a golden-section search over the hulls' corners finds it. Negative where no line passes between.
    """
    band = _Band(k_low, low, k_high, high, slope)
    tilt = _golden(band.width, -spread * slope, spread * slope)
    top, bottom = band.ends(tilt)
    return band.line((top + bottom) / 2, tilt, (top - bottom) / 2)


def mean_between(
    k_low: Float, low: Float, k_high: Float, high: Float, slope: float, spread: float
) -> tuple[Line, float] | None:
    """The mean of all lines between the points with a slope within `spread` (relative) of `slope`, and one sigma.

    All are held equally likely; sigma is the worse of the two ends'. None where none passes between.
    """
    band = _Band(k_low, low, k_high, high, slope)
    edge = spread * slope
    best = _golden(band.width, -edge, edge)
    if band.width(best) <= 0:
        return None
    first, last = _border(band, best, -edge), _border(band, best, edge)
    tilts = np.linspace(first, last, 65)
    ends = np.array([band.ends(tilt) for tilt in tilts.tolist()])
    width, level = np.maximum(ends[:, 0] - ends[:, 1], 0.0), ends.mean(axis=1)
    weight = width / width.sum() if width.sum() > 0 else np.full(len(tilts), 1 / len(tilts))
    tilt, middle = float(weight @ tilts), float(weight @ level)
    reach = np.array([min(k_low.min(), k_high.min()), max(k_low.max(), k_high.max())]) - band.centre
    apart = (level - middle)[:, None] + (tilts - tilt)[:, None] * reach[None, :]
    sigma = float(np.sqrt(np.max(weight @ (apart**2 + (width**2 / 12)[:, None]))))
    return band.line(middle, tilt, band.width(best) / 2), sigma


class _Band:
    """Room between two sets of points, as a function of a line's tilt against `slope`; coordinates reduced by it."""

    def __init__(self, k_low: Float, low: Float, k_high: Float, high: Float, slope: float) -> None:
        self.slope = slope
        self.centre = (float(np.mean(k_low)) + float(np.mean(k_high))) / 2
        self.base = float(np.min(high))
        hk, hy = k_high - self.centre, (high - self.base) - slope * (k_high - self.centre)
        lk, ly = k_low - self.centre, (low - self.base) - slope * (k_low - self.centre)
        upper, lower = lower_hull(hk, hy), lower_hull(lk, -ly)
        self.hk, self.hy, self.lk, self.ly = hk[upper], hy[upper], lk[lower], ly[lower]

    def ends(self, tilt: float) -> tuple[float, float]:
        """Highest and lowest level at the centre that the points leave."""
        return float(np.min(self.hy - tilt * self.hk)), float(np.max(self.ly - tilt * self.lk))

    def width(self, tilt: float) -> float:
        """The room between them; concave in the tilt."""
        top, bottom = self.ends(tilt)
        return top - bottom

    def line(self, level: float, tilt: float, margin: float) -> Line:
        """A line of the band in the points' own coordinates."""
        total = self.slope + tilt
        return Line(self.base + level - total * self.centre, total, margin)


def _border(band: _Band, inside: float, outside: float) -> float:
    """The tilt between `inside` and `outside` at which the room ends."""
    if band.width(outside) > 0:
        return outside
    for _ in range(40):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if band.width(middle) > 0 else (inside, middle)
    return inside


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
