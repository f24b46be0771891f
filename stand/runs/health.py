"""How each instrument's stream fares, for screens."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from stand.block import Block
from stand.runs.messages import InstrumentHealth

MEMORY = 0.4


class Meter:
    """Counts one instrument's blocks in its reader's thread; `read` may be called from another."""

    def __init__(self, stale: float) -> None:
        self._stale = stale
        self._samples, self._skipped, self._flagged, self._newest = 0, 0, 0, float("-inf")
        self._then, self._samples_then = float("-inf"), 0
        self._recent: deque[Block] = deque()
        self.lost = False

    def count(self, block: Block) -> None:
        """One block more."""
        self._samples += len(block)
        self._skipped += block.skipped
        self._flagged += int((block.flags != 0).sum())
        self._newest = block.arrival
        self._recent.append(block)
        while self._recent[0].arrival < block.arrival - MEMORY:
            self._recent.popleft()
        self.lost = False

    def recent(self) -> NDArray[np.float64]:
        """The unflagged values of about the last MEMORY seconds, [n]."""
        blocks = list(self._recent)
        return np.concatenate([b.values[b.flags == 0] for b in blocks]) if blocks else np.empty(0)

    @property
    def samples(self) -> int:
        """Decoded so far."""
        return self._samples

    def age(self, now: float) -> float:
        """Seconds since the newest sample."""
        return now - self._newest

    def read(self, now: float) -> InstrumentHealth:
        """The state at host time `now`; the rate is that since the reading before."""
        rate = (self._samples - self._samples_then) / (now - self._then)
        self._then, self._samples_then = now, self._samples
        age = self.age(now)
        state = "lost" if self.lost else "stale" if age > self._stale else "ok"
        return InstrumentHealth(state, self._samples, rate, age, self._skipped, self._flagged)
