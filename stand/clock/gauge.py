"""A streaming gauge's clock and the frames it lost, from reads that count frames and know when they came."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stand.clock.arrivals import Bounds, Int, Reads, bounds_of
from stand.clock.gaps import SLACK, Gap, find_gaps, shift
from stand.clock.lines import Line, line_below, line_between
from stand.clock.model import Clock

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
    bounds = bounds_of(reads, period, byte_time, length)
    gaps = find_gaps(bounds, reads, period)
    shifted = _without_doubt(shift(bounds, reads.frames, gaps), reads, gaps)
    line, method = _line(shifted, period)
    fit_sigma = _sigma(shifted, period, line)
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


def _line(bounds: Bounds, period: float) -> tuple[Line, str]:
    if bounds.two_sided:
        line = line_between(bounds.late, bounds.after, bounds.early, bounds.before, period)
        if line.margin > -SLACK * period:
            return line, "ticks"
    return line_below(bounds.early, bounds.before, period), "envelope"


def _sigma(bounds: Bounds, period: float, line: Line) -> float:
    """From two interleaved halves of the reads, and from the room that the bounds leave."""
    halves = []
    for part in (0, 1):
        some = replace(bounds, **{f: getattr(bounds, f)[part::2] for f in ("early", "before", "late", "after")})
        if len(some.early) < 10:
            return float(period / np.sqrt(12))
        halves.append(_line(some, period)[0])
    where = np.array([bounds.early[0], bounds.early[-1]])
    apart = float(np.max(np.abs(halves[0].at(where) - halves[1].at(where))))
    room = max(line.margin, 0.0) / np.sqrt(3) if bounds.two_sided else 0.0
    return float(np.hypot(apart / 2, room))
