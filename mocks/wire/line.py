"""A serial line: bytes leave one after another at the baud rate and are handed over as an adapter does."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numba import njit
from numpy.typing import NDArray

Float = NDArray[np.float64]


@njit(cache=True)
def _leave(free, ready, size, byte_time, ends, out):  # type: ignore[no-untyped-def]
    """When frames [n] that are ready at times [n] have left the line, free from `free` on, and each byte [n, size]."""
    length = size * byte_time
    latest = free
    for i in range(ready.size):
        latest = max(latest, ready[i] - length * i)
        start = length * i + latest
        for k in range(size):
            out[i, k] = start + byte_time * (k + 1.0)
        ends[i] = start + length


@dataclass
class Line:
    """Bytes under way. byte_time: s for one byte (10 bits); free: when the line's last byte has left."""

    byte_time: float
    free: float = -np.inf
    data: bytearray = field(default_factory=bytearray)
    times: Float = field(default_factory=lambda: np.empty(0))

    def put_frames(self, frames: NDArray[np.uint8], ready: Float) -> Float:
        """Frames [n, size] that are ready at times [n]; returns when the last byte of each has left.

        A frame starts when it is ready and the one before has left:
        end_k = L (k + 1) + max(free, max over j <= k of (ready_j - L j)).
        """
        count, size = frames.shape
        ends, each = np.empty(count), np.empty((count, size))
        _leave(self.free, ready, size, self.byte_time, ends, each)
        self._append(frames.tobytes(), each.ravel())
        self.free = float(ends[-1])
        return ends

    def put(self, data: bytes, ready: float) -> None:
        """Some bytes, such as an answer."""
        start = max(self.free, ready)
        leaving: Float = start + self.byte_time * np.arange(1.0, len(data) + 1)
        self._append(data, leaving)
        self.free = start + self.byte_time * len(data)

    def _append(self, data: bytes, times: Float) -> None:
        self.data += data
        self.times = np.concatenate([self.times, times]) if len(self.times) else times

    def take(self, until: float) -> bytes:
        """The bytes that have left by `until`."""
        count = int(np.searchsorted(self.times, until, side="right"))
        taken = bytes(self.data[:count])
        del self.data[:count]
        self.times = self.times[count:]
        return taken

    def clear(self) -> None:
        """Forget what is under way."""
        self.data.clear()
        self.times = np.empty(0)


@dataclass
class Adapter:
    """When bytes reach the host: at once, or with the ticks of an adapter's timer, each time a host's jitter later.

    timer: s, 0 for none. jitter: (least, most) s. phase: s of the first tick.
    """

    rng: np.random.Generator
    timer: float = 0.0
    jitter: tuple[float, float] = (0.0, 0.0)
    phase: float = 0.0

    def tick_after(self, time: float) -> float:
        """The first tick of the timer after a time."""
        return self.phase + (math.floor((time - self.phase) / self.timer) + 1.0) * self.timer

    def delay(self) -> float:
        """The host's jitter this time, s."""
        low, high = self.jitter
        return float(self.rng.uniform(low, high)) if high > 0 else 0.0
