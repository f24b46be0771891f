"""What one instrument sent at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Block:
    """Samples that arrived together, as decoded; nothing is scaled, dropped or stamped one by one here.

    instrument: its name in the stand's configuration.
    first: the host's count of this instrument's samples before this block (a lost frame is not counted).
    values: float64 [n], in SI.
    ticks: the device's own sample counter, int64 [n], where its frames carry one.
    flags: uint8 [n], 1 where the device itself reports a fault with the sample (overload, alarm), else 0.
    arrival: host time of the read that completed the block, s on the acquisition's monotonic clock.
    skipped: bytes of junk passed over since the block before.
    request: for a polled instrument, host time just before the question was sent, s.
    tail: bytes of a frame that had begun and was not complete at `arrival`.
    span: bytes of the stream from its first frame's first byte to `arrival`, which earlier reads may have brought.
    """

    instrument: str
    first: int
    values: NDArray[np.float64]
    ticks: NDArray[np.int64] | None
    flags: NDArray[np.uint8]
    arrival: float
    skipped: int = 0
    request: float | None = None
    tail: int = 0
    span: int = 0

    def __len__(self) -> int:
        return len(self.values)
