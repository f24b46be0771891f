"""The counted position ring that a NanoJ program of 1 ms cycle keeps in the drive's outputs 2500h."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mocks.devices.clock import DeviceClock
from mocks.devices.kernels import take_ring

Float = NDArray[np.float64]

DEPTH = 60
WORDS = DEPTH + 4
RATE = 1000.0
UNIT = 1e-7  # m
Sampled = Callable[[NDArray[np.int64], Float, Float, Float], None]


class Ring:
    """Sample k is taken at drive time k ms. Sub 1 counts the samples, sub 2 holds the newest, i32 of 0.1 um; two to a
    sub there follow 60 cells: cell k mod 60 holds sample k less sample k - 1, an i16 that saturates.

    encoder: (resolution, noise) m. sampled: told of every batch (counter, true time, value, true value).
    """

    def __init__(
        self, clock: DeviceClock, encoder: tuple[float, float], rng: np.random.Generator, sampled: Sampled
    ) -> None:
        self.clock, self.rng, self.sampled = clock, rng, sampled
        self.resolution, self.noise = encoder
        self.count = 0
        self.cells, self.newest = np.zeros(DEPTH, np.int16), 0
        self._before = (np.inf, 0.0)

    def measure(self, position: Float) -> Float:
        """What the encoder makes of positions [n]."""
        noisy = position + self.noise * self.rng.standard_normal(len(position))
        return np.rint(noisy / self.resolution) * self.resolution if self.resolution else noisy

    def record(self, times: Float, position: Float) -> None:
        """Take every sample that is due by times[-1]; times [n] are the true times of positions [n]."""
        last = math.floor(self.clock.device(float(times[-1])) * RATE)
        if last >= self.count:
            noise = self.rng.standard_normal(last + 1 - self.count)
            due, value, true, self.newest = take_ring(
                self.count, *self._before, times, position, RATE, self.clock.epoch, self.clock.drift, noise, self.noise,
                self.resolution, UNIT, self.cells, self.newest,
            )  # fmt: skip
            self.sampled(np.arange(self.count, last + 1), due, value, true)
            self.count = last + 1
        self._before = float(times[-1]), float(position[-1])

    def registers(self, word_order: str) -> list[int]:
        """The 64 registers at 2000: number of samples so far, the newest, then the cells."""
        return packed(self.count, self.newest, self.cells, word_order)


def packed(count: int, newest: int, cells: NDArray[np.int16], word_order: str) -> list[int]:
    """The ring's registers [WORDS]: samples so far, the newest and the cells [DEPTH]."""
    text = struct.pack(f">Ii{DEPTH}h", count & 0xFFFFFFFF, newest, *cells.tolist())
    words = struct.unpack(f">{WORDS}H", text)
    return list(words) if word_order == "big" else [words[i ^ 1] for i in range(WORDS)]
