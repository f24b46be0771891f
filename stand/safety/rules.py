"""Rules: a block in, a trip or None out. They own no clock, no wire and no thread."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stand.block import Block
from stand.safety.trip import Trip


class Rule(Protocol):
    """Whatever can find fault with one instrument's blocks, in the order in which they arrived."""

    @property
    def instrument(self) -> str:
        """The instrument whose blocks it wants to see."""

    def look(self, block: Block) -> Trip | None:
        """The trip that this block calls for, if any."""


@dataclass(frozen=True, slots=True)
class RangeRule:
    """`low` <= value - zero <= `high`, in the block's SI unit; a value that is not a number trips, too."""

    name: str
    instrument: str
    low: float
    high: float
    unit: str
    zero: float = 0.0

    def look(self, block: Block) -> Trip | None:
        """The block's largest violation as a trip."""
        valid = block.values[block.flags == 0] if block.flags.any() else block.values
        if not len(valid):
            return None
        low, high = float(valid.min()) - self.zero, float(valid.max()) - self.zero
        if low >= self.low and high <= self.high:
            return None
        if not (np.isfinite(low) and np.isfinite(high)):
            return self._trip(block, "is not a number", None, None)
        if high > self.high:
            return self._trip(block, "is above its limit", high, self.high)
        return self._trip(block, "is below its limit", low, self.low)

    def _trip(self, block: Block, what: str, value: float | None, limit: float | None) -> Trip:
        return Trip(self.name, f"{block.instrument} {what}", block.instrument, value, limit, self.unit, block.arrival)


@dataclass(slots=True)
class SpeedRule:
    """|difference quotient over `span` samples| <= `limit`; `rate` in Hz is the instrument's nominal one."""

    name: str
    instrument: str
    limit: float
    rate: float
    unit: str = "m/s"
    span: int = 8
    _tail: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    _ticks: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, np.int64))

    def look(self, block: Block) -> Trip | None:
        """The largest speed that ends in this block, if it is above the limit."""
        values = np.concatenate((self._tail, block.values))
        ticks = np.concatenate((self._ticks, self._count(block)))
        self._tail, self._ticks = values[-self.span :], ticks[-self.span :]
        if len(values) <= self.span:
            return None
        steps = ticks[self.span :] - ticks[: -self.span]
        speed = np.abs(values[self.span :] - values[: -self.span]) * self.rate / np.maximum(steps, 1)
        fastest = float(speed.max())
        if fastest <= self.limit:
            return None
        what = f"{block.instrument} moves too fast"
        return Trip(self.name, what, block.instrument, fastest, self.limit, self.unit, block.arrival)

    def _count(self, block: Block) -> NDArray[np.int64]:
        if block.ticks is not None:
            return block.ticks
        return np.arange(block.first, block.first + len(block), dtype=np.int64)


@dataclass(frozen=True, slots=True)
class FlagRule:
    """No sample that the device itself reports as faulty (overload, alarm, drive fault)."""

    name: str
    instrument: str

    def look(self, block: Block) -> Trip | None:
        """The first flagged sample as a trip."""
        if not block.flags.any():
            return None
        flag = int(block.flags[np.flatnonzero(block.flags)[0]])
        what = f"{block.instrument} reports a fault with its sample (flag {flag})"
        return Trip(self.name, what, block.instrument, arrival=block.arrival)


@dataclass(slots=True)
class StaleRule:
    """No instrument is silent for longer than its limit, s; asked by the clock, not by blocks."""

    limits: dict[str, float]
    _last: dict[str, float] = field(default_factory=dict)

    def start(self, now: float) -> None:
        """From now on silence counts."""
        self._last = dict.fromkeys(self.limits, now)

    def heard(self, instrument: str, arrival: float) -> None:
        """An instrument delivered samples."""
        self._last[instrument] = arrival

    def look(self, now: float) -> Trip | None:
        """The instrument that has been silent for too long."""
        for instrument, limit in self.limits.items():
            silent = now - self._last.get(instrument, now)
            if silent > limit:
                what = f"{instrument} sends nothing"
                return Trip("stale data", what, instrument, silent, limit, "s", arrival=now)
        return None
