"""What a read of a serial stream says of a frame's time: bounds from below and, in a timer's bunches, from above.

With frame k's last byte in the host's hands at t(k) = offset + k period at the earliest, a read at A that holds k
whole frames and b bytes of the next says t(k - 1) <= A. A USB adapter hands its bytes over at ticks of a timer: then
the next byte had not come when the timer ticked, and the tick's time, fitted over all ticks, bounds t from above.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.clock.lines import line_under

Float = NDArray[np.float64]
Int = NDArray[np.int64]

#: share of a frame period by which what a tick brought may be off whole periods, and so many reads in a row that are
#: off make a new beginning
PHASE, STRAYED = 0.4, 5


@dataclass(frozen=True)
class Reads:
    """time s [k]; frames int64 [k], whole frames received by then; partial int64 [k], bytes of the next one."""

    time: Float
    frames: Int
    partial: Int


@dataclass(frozen=True)
class Bounds:
    """t(early) <= before + and t(late) >= after: indices, times s and the read that each belongs to.

    two_sided: whether `late` bounds are there. residual: of the ticks, median s; doubt: of their line, s.
    """

    early: Float
    before: Float
    late: Float
    after: Float
    read: Int
    two_sided: bool
    residual: float
    doubt: float = 0.0


@dataclass(frozen=True)
class Ticks:
    """A periodic timer behind the arrivals.

    time: of each read's tick s [k], NaN for a read that holds no whole tick; lateness: of the reads, median s; doubt:
    how far the timer's own line may be off, s.
    """

    time: Float
    lateness: float
    doubt: float


def find_ticks(time: Float, content: Float, frame_period: float) -> Ticks | None:
    """The timer whose bunches these arrivals are, or None where they come at no fixed period.

    content [k]: frames and parts of a frame received by then. It is what had left the line when the timer ticked, so
    it tells the ticks apart however late the reads are.
    """
    told = content * frame_period
    steps = np.diff(told)
    some = steps[steps > 1.5 * frame_period]
    if len(some) < 20:
        return None
    period = float(np.median(some))
    if period < 4 * frame_period:
        return None
    off = PHASE * frame_period
    period = float(np.mean(some[np.abs(some - period) <= off]))  # each alone is known to a byte or a gap between frames
    number, whole = _count_ticks(told, period, off)
    if np.count_nonzero(whole) < 0.8 * len(time):
        return None
    number[whole] += _skipped(time[whole] - period * number[whole], period)
    line = line_under(number[whole], time[whole], period)
    late = time[whole] - line.at(number[whole])
    if _unsteady(late):
        return None
    ticked = np.where(whole, line.at(number), np.nan)
    return Ticks(ticked, float(np.median(late)), _doubt(number[whole], time[whole], period))


def _count_ticks(told: Float, period: float, off: float) -> tuple[Float, NDArray[np.bool_]]:
    """The number of ticks by each read, and which reads hold whole ticks: steps of whole periods, give or take `off` s.

    A host's buffer that was full gives some of a tick only; a lost frame shifts what is a whole tick from there on.
    """
    number, whole = np.zeros(len(told)), np.ones(len(told), dtype=np.bool_)
    last, count, others = float(told[0]), 0, 0
    for i, now in enumerate(told.tolist()):
        turns = round((now - last) / period)
        others = 0 if abs(now - last - turns * period) <= off else others + 1
        whole[i] = others in (0, STRAYED)
        if whole[i]:
            last, count, others = now, count + turns, 0
        number[i] = count
    return number, whole


def _skipped(rest: Float, period: float, window: int = 12) -> Float:
    """Ticks that brought nothing by each read, where the stream had stopped for a while: all that follow are late."""
    last = np.concatenate((rest, np.full(window - 1, np.inf)))
    promptest = np.lib.stride_tricks.sliding_window_view(last, window).min(axis=1)
    skipped: Float = np.cumsum(np.round(np.diff(promptest, prepend=promptest[0]) / period))
    return skipped


def _unsteady(late: Float, window: int = 24, allowed: float = 250e-6) -> bool:
    """Whether the arrivals stray from a strict period: the promptest of each two dozen should be prompt."""
    count = len(late) // window
    if count < 2:
        return True
    promptest = late[: count * window].reshape(count, window).min(axis=1)
    return float(np.quantile(promptest, 0.75)) > allowed


def _doubt(number: Float, time: Float, period: float) -> float:
    """How far the lines of two halves of the reads are apart at most, halved."""
    one, two = (line_under(number[part::2], time[part::2], period) for part in (0, 1))
    ends = number[[0, -1]]
    return float(np.max(np.abs(one.at(ends) - two.at(ends)))) / 2


def bounds_of(reads: Reads, frame_period: float, byte_time: float, length: int, timed: bool = True) -> Bounds:
    """The bounds that the reads give; byte_time s on the line, length bytes in a frame; timed: look for a timer."""
    ticks = find_ticks(reads.time, reads.frames + reads.partial / length, frame_period) if timed else None
    cut = bool(np.mean(reads.partial > 0) > 0.02)
    begun = reads.partial > 0
    early = np.where(begun, reads.frames, reads.frames - 1).astype(np.float64)
    wait = np.where(begun, (length - reads.partial) * byte_time, 0.0)
    index = np.arange(len(reads.time))
    if ticks is None:
        nothing = np.empty(0)
        return Bounds(early, reads.time + wait, nothing, nothing, index[:0], False, 0.0)
    late = reads.frames.astype(np.float64)
    left = (length - reads.partial - 1) * byte_time if cut else np.zeros(len(late))
    whole = np.isfinite(ticks.time)
    before = np.where(whole, ticks.time, reads.time) + wait
    whole[-1] = False  # after the last read there may be no next byte: the stream has ended
    after = (ticks.time + left)[whole]
    return Bounds(early, before, late[whole], after, index[whole], True, ticks.lateness, ticks.doubt)
