"""Frames that never arrived: where no steady clock fits the reads any more, frames are missing not long before."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stand.clock.arrivals import Bounds, Float, Int, Reads
from stand.clock.lines import line_below, line_between

#: share of a frame period by which bounds may miss each other before a frame must be missing
SLACK = 0.06
#: where no timer bounds them: the promptest read of a stretch comes within this share of a frame period, and the
#: stretches, s, that are tried for it, shortest first
PROMPT, STEADY = 0.75, 0.3
STRETCHES = (0.04, 0.08, 0.16, 0.32, 0.64)
#: a read that is late is forgiven; so many in one run say that the host was too busy for this search
FORGIVEN = 40
#: so many breaks in one run, mended or forgiven, are no lost frames but a host that stood still: the search ends
MENDS = 60
#: of each such stretch, s, the promptest read tells whether it keeps to the clock, within a share of a frame period
LEVEL, NEAR = 0.4, 0.2
#: whether gaps are believed is judged by the promptest read in this many seconds
FEW = 0.02
#: reads are thinned to the promptest in this many seconds; a loss is placed with a second of reads beyond it
THIN, HORIZON, SPAN = 0.004, 1.0, 10.0


@dataclass(frozen=True, slots=True)
class Gap:
    """`count` frames are missing before the frame that the host counted as `frame`."""

    frame: int
    count: int


def shift(bounds: Bounds, frames: Int, gaps: tuple[Gap, ...]) -> Bounds:
    """The bounds with true indices: every frame after a gap counts on."""
    early, late = bounds.early.copy(), bounds.late.copy()
    for gap in gaps:
        early[frames > gap.frame] += gap.count
        late[frames[bounds.read] > gap.frame] += gap.count
    return replace(bounds, early=early, late=late)


def find_gaps(bounds: Bounds, reads: Reads, period: float) -> tuple[Gap, ...]:
    """All gaps, one after another in time."""
    watched = _watched(bounds, reads, period)
    if watched is None:
        return ()
    search = _Search(*watched, period)
    begin = 0
    while begin < len(search.time) and search.forgiven < FORGIVEN and search.mends < MENDS:
        end = search.until(begin, SPAN)
        broken = search.breaks(begin, end)
        if broken is not None:
            search.mend(begin, broken)
        elif end == len(search.time):
            break
        else:
            begin = search.until(begin, SPAN / 2)
    return search.gaps if bounds.two_sided else _believed(bounds, reads, search.gaps, period)


def _believed(bounds: Bounds, reads: Reads, gaps: tuple[Gap, ...], period: float) -> tuple[Gap, ...]:
    """Those of the gaps, and as large, that let most stretches of the run keep to one clock, one after another.

    A host that is late for a while looks like a loss that is made good again, and a clock that runs a little fast
    takes in what is left of it: such a gap helps no other stretch.
    """
    bounds, frames = _thinned(bounds, reads, period)
    held: tuple[Gap, ...] = ()
    best = _level(bounds, period)
    left = list(gaps)
    while left:
        trials = [Gap(gap.frame, count) for gap in left for count in sorted({gap.count, 1, 2, 3})]
        levels = [_level(shift(bounds, frames, (*held, trial)), period) for trial in trials]
        if max(levels) <= best:
            break
        best, found = max(levels), trials[int(np.argmax(levels))]
        held = tuple(sorted((*held, found), key=lambda gap: gap.frame))
        left = [gap for gap in left if gap.frame != found.frame]
    return held


def _thinned(bounds: Bounds, reads: Reads, period: float) -> tuple[Bounds, Int]:
    """Only the promptest read of each short while, one-sided, and their frames: a line below all rests on such."""
    keep = _promptest(bounds.before - period * bounds.early, bounds.before, FEW, 1)
    early, before, none = bounds.early[keep], bounds.before[keep], slice(0)
    late, after, read = bounds.late[none], bounds.after[none], bounds.read[none]
    return replace(bounds, early=early, before=before, late=late, after=after, read=read), reads.frames[keep]


def _level(bounds: Bounds, period: float) -> int:
    """How many stretches have their promptest read on the line below all of them."""
    slope = line_below(bounds.early, bounds.before, period).slope
    first = _promptest(bounds.before - slope * bounds.early, bounds.before, LEVEL, 3)
    if len(first) < 3:
        return 0
    index, time = bounds.early[first], bounds.before[first]
    return int(np.count_nonzero(time - line_below(index, time, period).at(index) < NEAR * period))


def _watched(bounds: Bounds, reads: Reads, period: float) -> tuple[Bounds, Int] | None:
    """Bounds from both sides and the frames received by each read; None where the host was too busy to have any.

    Without a timer the reads are thinned, and of each stretch of time the promptest is taken to be prompt. The stretch
    is the shortest whose promptest reads keep level with their neighbours (a gap is one step among many).
    """
    if bounds.two_sided:
        return bounds, reads.frames
    slope = line_below(bounds.early, bounds.before, period).slope
    rest = bounds.before - slope * bounds.early
    keep = _promptest(rest, bounds.before, THIN, 1)
    early, before, rest, frames = bounds.early[keep], bounds.before[keep], rest[keep], reads.frames[keep]
    for stretch in STRETCHES:
        first = _promptest(rest, before, stretch, 3)
        steps = np.abs(np.diff(rest[first]))
        if len(steps) > 5 and float(np.quantile(steps, 0.9)) < STEADY * period:
            late, after = early[first], before[first] - PROMPT * period
            return Bounds(early, before, late, after, first, True, bounds.residual), frames
    return None


def _promptest(rest: Float, time: Float, stretch: float, least: int) -> Int:
    """The read with the least delay in each stretch of time that holds at least `least` reads."""
    number = np.floor((time - time[0]) / stretch).astype(np.int64)
    order = np.lexsort((rest, number))
    first = order[np.concatenate(([True], np.diff(number[order]) > 0))]
    enough = np.bincount(number, minlength=int(number[-1]) + 1)[number[first]] >= least
    enough[-1] &= least == 1
    return np.sort(first[enough])


class _Search:
    """The state of a search through a run: bounds in true indices so far, and the gaps found."""

    def __init__(self, bounds: Bounds, frames: Int, period: float) -> None:
        self.bounds, self.frames, self.period = bounds, frames, period
        self.time = bounds.before
        self.gaps: tuple[Gap, ...] = ()
        self.forgiven = self.mends = 0

    def until(self, begin: int, seconds: float) -> int:
        """The first read later than `seconds` after read `begin`."""
        later = np.flatnonzero(self.time[begin:] > self.time[begin] + seconds)
        return begin + int(later[0]) if len(later) else len(self.time)

    def margin(self, bounds: Bounds, begin: int, end: int) -> float:
        """How well one clock fits reads begin..end, s; negative where none does."""
        some = (bounds.read >= begin) & (bounds.read < end)
        if np.count_nonzero(some) < 2:
            return self.period
        early, before = bounds.early[begin:end], bounds.before[begin:end]
        return line_between(bounds.late[some], bounds.after[some], early, before, self.period, 3e-4).margin

    def breaks(self, begin: int, end: int) -> int | None:
        """One past the first read at which no clock fits any more; None where one fits all."""
        if self.margin(self.bounds, begin, end) >= -SLACK * self.period:
            return None
        good, bad = begin + 2, end
        while bad - good > 1:
            middle = (good + bad) // 2
            fits = self.margin(self.bounds, begin, middle) >= -SLACK * self.period
            good, bad = (middle, bad) if fits else (good, middle)
        return bad

    def mend(self, begin: int, end: int) -> None:
        """Add the gap that explains the break, or forgive the read: the host was late there, nothing is missing."""
        self.mends += 1
        found = self._place(begin, end)
        if found is None:
            self.forgiven += 1
            keep = self.bounds.read != end - 1
            if bool(np.all(keep)):  # a bound from below broke it: only an earlier bound from above can give way
                keep = self.bounds.read != int(np.max(self.bounds.read[self.bounds.read < end]))
            kept = {name: getattr(self.bounds, name)[keep] for name in ("late", "after", "read")}
            self.bounds = replace(self.bounds, **kept)
            return
        self.gaps = (*self.gaps, found)
        self.bounds = shift(self.bounds, self.frames, (found,))

    def _place(self, begin: int, end: int) -> Gap | None:
        """The earliest place before `end` that lets one clock fit as well as any up to a second beyond it."""
        last = self.until(end - 1, HORIZON)
        first = max(begin + 1, int(np.searchsorted(self.time, self.time[end - 1] - HORIZON)))
        places = np.arange(first, end)
        for count in self._counts(begin, end, last):
            step = max(1, len(places) // 16)
            coarse = [self._margin_with(begin, last, int(p), count) for p in places[::step]]
            best = int(np.argmax(coarse)) * step
            near = places[max(0, best - 2 * step) : best + step + 1]
            fine = np.array([self._margin_with(begin, last, int(p), count) for p in near])
            if fine.max() >= -SLACK * self.period:
                place = near[int(np.argmax(fine >= fine.max() - 0.04 * self.period))]
                return Gap(int(self.frames[place - 1]), count)
        return None

    def _counts(self, begin: int, end: int, last: int) -> list[int]:
        """How many frames may be missing, likeliest first."""
        line = line_below(self.bounds.early[begin : end - 1], self.time[begin : end - 1], self.period)
        ahead = slice(end - 1, min(end + 7, last))
        late = float(np.min(self.time[ahead] - line.at(self.bounds.early[ahead])))
        guess = max(1, round(late / self.period))
        return [guess, guess + 1, guess - 1] if guess > 1 else [1, 2]

    def _margin_with(self, begin: int, end: int, place: int, count: int) -> float:
        gap = Gap(int(self.frames[place - 1]), count)
        return self.margin(shift(self.bounds, self.frames, (gap,)), max(begin, place - 250), end)
