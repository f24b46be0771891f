"""A streaming gauge's clock and the frames it lost, from reads that count frames and know when they came."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stand.clock.arrivals import Bounds, Int, Reads, bounds_of
from stand.clock.gaps import SLACK, Gap, find_gaps, shift
from stand.clock.lines import Line, line_below, line_between, mean_between
from stand.clock.model import Clock

#: crystals keep to this (relative); a slower or faster clock is believed where the reads leave no other
TOLERANCE, WIDE = 55e-6, 2e-3
#: a gap's place is sure to this many seconds
DOUBT = 0.06


@dataclass(frozen=True)
class GaugeFit:
    """The clock in true indices (lost frames counted), and the gaps in the host's count."""

    clock: Clock
    gaps: tuple[Gap, ...]

    def true_index(self, count: Int) -> Int:
        """The true indices of frames by the host's count."""
        index = count.copy()
        for gap in self.gaps:
            index[count >= gap.frame] += gap.count
        return index


def fit_gauge(
    reads: Reads, period: float, byte_time: float, length: int, latency: float, latency_sigma: float
) -> GaugeFit:
    """Clock and gaps. period: nominal, s; latency s (sample taken -> last byte in the host's hands, earliest)."""
    for timed in (True, False):
        bounds = bounds_of(reads, period, byte_time, length, timed)
        gaps = find_gaps(bounds, reads, period)
        shifted = _without_doubt(shift(bounds, reads.frames, gaps), reads, gaps)
        line, method, room = _line(shifted, period)
        if method == "ticks" or not bounds.two_sided:
            break
    fit_sigma = _sigma(shifted, period) if room is None else room
    residual = float(np.median(shifted.before - line.at(shifted.early)))
    sigma = float(np.hypot(fit_sigma, latency_sigma))
    drift = period / line.slope - 1
    clock = Clock(line.intercept - latency, line.slope, drift, residual, fit_sigma, sigma, latency, method)
    return GaugeFit(clock, gaps)


def _without_doubt(bounds: Bounds, reads: Reads, gaps: tuple[Gap, ...]) -> Bounds:
    """Without the reads so near a gap that they may lie on its other side."""
    sure = np.ones(len(reads.time), dtype=np.bool_)
    for gap in gaps:
        at = reads.time[min(int(np.searchsorted(reads.frames, gap.frame, "right")), len(reads.time) - 1)]
        sure &= np.abs(reads.time - at) > DOUBT
    if np.count_nonzero(sure) < 10:
        return bounds
    late = sure[bounds.read]
    kept = {name: getattr(bounds, name)[late] for name in ("late", "after", "read")}
    return replace(bounds, early=bounds.early[sure], before=bounds.before[sure], **kept)


def _line(bounds: Bounds, period: float) -> tuple[Line, str, float | None]:
    """The clock's line, how it was found, and one sigma where the bounds state it by themselves."""
    if bounds.two_sided:
        points = (bounds.late, bounds.after, bounds.early, bounds.before)
        fuzz = 6.0 * bounds.residual / len(bounds.early)  # how far the ticks stray from their line
        for spread in (TOLERANCE, WIDE):
            lacking = max(0.0, -line_between(*points, period, spread).margin)
            if lacking > SLACK * period * (0.5 if spread == TOLERANCE else 1.0):
                continue
            room = lacking + fuzz
            found = mean_between(points[0], points[1] - room, points[2], points[3] + room, period, spread)
            if found is not None:  # a timer that keeps step with the frames leaves much open, and sigma says so
                return found[0], "ticks", float(np.hypot(found[1], fuzz + bounds.doubt))
    return line_below(bounds.early, bounds.before, period), "envelope", None


def _sigma(bounds: Bounds, period: float) -> float:
    """From two interleaved halves of the reads."""
    halves = []
    for part in (0, 1):
        some = replace(
            bounds, **{name: getattr(bounds, name)[part::2] for name in ("early", "before", "late", "after")}
        )
        if len(some.early) < 10:
            return float(period / np.sqrt(12))
        halves.append(_line(some, period)[0])
    where = np.array([bounds.early[0], bounds.early[-1]])
    return float(np.max(np.abs(halves[0].at(where) - halves[1].at(where)))) / 2
