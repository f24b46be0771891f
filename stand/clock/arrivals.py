"""What a read of a serial stream says of a frame's time: bounds from below and, in a timer's bunches, from above.

With frame k's last byte in the host's hands at t(k) = offset + k period at the earliest, a read at A that holds k
whole frames and b bytes of the next says t(k - 1) <= A. A USB adapter hands its bytes over at ticks of a timer: then
the next byte had not come when the timer ticked, and the tick's time, fitted over all ticks, bounds t from above.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.clock.lines import Line, line_below

Float = NDArray[np.float64]
Int = NDArray[np.int64]


@dataclass(frozen=True)
class Reads:
    """time s [k]; frames int64 [k], whole frames received by then; partial int64 [k], bytes of the next one."""

    time: Float
    frames: Int
    partial: Int


@dataclass(frozen=True)
class Bounds:
    """t(early) <= before + and t(late) >= after: indices, times s and the read that each belongs to.

    two_sided: whether `late` bounds are there. residual: of the ticks, median s. tight: bounds come from bytes.
    """

    early: Float
    before: Float
    late: Float
    after: Float
    read: Int
    two_sided: bool
    residual: float


@dataclass(frozen=True)
class Ticks:
    """A periodic timer behind the arrivals: each read's tick time s [k], and how late the reads were, median s."""

    time: Float
    lateness: float


def find_ticks(time: Float, frame_period: float) -> Ticks | None:
    """The timer whose bunches these arrivals are, or None where they come at no fixed period."""
    gaps = np.diff(time)
    gaps = gaps[gaps > 0.5e-3]
    if len(gaps) < 20:
        return None
    period = float(np.median(gaps))
    if period < 4 * frame_period:
        return None
    turns = gaps / period
    off = np.abs(turns - np.round(turns))
    if np.quantile(off, 0.8) > 0.15:
        return None
    steps = np.round(np.diff(time) / period)
    number = np.concatenate(([0.0], np.cumsum(steps)))
    line = line_below(number, time, period)
    late = time - line.at(number)
    if _unsteady(late):
        return None
    number = np.floor((time - line.intercept) / line.slope + 1e-6)
    return Ticks(line.at(number), float(np.median(late)))


def _unsteady(late: Float, window: int = 12, allowed: float = 80e-6) -> bool:
    """Whether the arrivals stray from a strict period: the promptest of each dozen should be prompt."""
    count = len(late) // window
    if count < 3:
        return True
    promptest = late[: count * window].reshape(count, window).min(axis=1)
    return float(np.quantile(promptest, 0.9)) > allowed


def bounds_of(reads: Reads, frame_period: float, byte_time: float, length: int) -> Bounds:
    """The bounds that the reads give; byte_time s on the line, length bytes in a frame."""
    ticks = find_ticks(reads.time, frame_period)
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
    after = (ticks.time + left)[:-1]  # after the last read there may be no next byte: the stream has ended
    return Bounds(early, ticks.time + wait, late[:-1], after, index[:-1], True, ticks.lateness)


def envelope(bounds: Bounds, period: float) -> Line:
    """The line under the earliest arrivals."""
    return line_below(bounds.early, bounds.before, period)
