"""How late the live stream is: quantiles of the newest few thousand blocks."""

from __future__ import annotations

from collections import deque

import numpy as np


class Latency:
    """Collects seconds from a block's newest sample to its publication."""

    def __init__(self, keep: int = 4096) -> None:
        self._seconds: deque[float] = deque(maxlen=keep)

    def add(self, seconds: float) -> float:
        """Take one value and return it."""
        self._seconds.append(seconds)
        return seconds

    def quantiles(self) -> dict[str, float] | None:
        """{"p50", "p99", "max", "blocks"}; None before the first block."""
        if not self._seconds:
            return None
        values = np.fromiter(self._seconds, dtype=np.float64)
        p50, p99 = np.quantile(values, [0.5, 0.99])
        return {"p50": float(p50), "p99": float(p99), "max": float(values.max()), "blocks": len(values)}
