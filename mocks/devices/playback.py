"""Devices that play a recording: the gauges' bytes as they came, the drive's ring as its samples were taken."""

from __future__ import annotations

import os
import select
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mocks.devices.ring import DEPTH, WORDS, packed
from mocks.wire.terminal import Terminal

Float = NDArray[np.float64]

RING_RATE = 1000.0
PPM, SPREAD = 1e-6, 120
SETTLE = 0.2  # s between the moment that everybody listens and the first byte


@dataclass
class PlayClock:
    """Recording time at a true time. speed: of the recording's seconds; 0 for as fast as they are taken.

    origin: recording time at which everything begins. It stands there until `begin`.
    """

    speed: float
    origin: float
    started: float = np.inf
    listening: threading.Event = field(default_factory=threading.Event)

    def begin(self, now: float) -> None:
        """Everybody listens: play from a little later on."""
        if not self.listening.is_set():
            self.started = now + SETTLE
            self.listening.set()

    def recorded(self, now: float) -> float:
        """Recording time, s; -inf before the start."""
        if now < self.started:
            return -np.inf
        return self.origin + (now - self.started) * self.speed if self.speed else np.inf

    def true(self, recorded: float) -> float:
        """When the clock comes to a recording time."""
        return self.started + (recorded - self.origin) / self.speed if self.speed else self.started


class RecordedRing:
    """The ring of a recording, told at any time how many of its samples were taken by then.

    registers uint16 [polls, 64], request and response times s [polls]. It never runs more than its depth ahead of
    its reader, so none of its samples is lost however slowly it is read. ValueError where there is no ring.
    """

    def __init__(self, registers: NDArray[np.uint16], request: Float, response: Float, clock: PlayClock) -> None:
        if registers.ndim != 2 or registers.shape[1] != WORDS or len(registers) < 2:
            raise ValueError(f"registers of shape {registers.shape} are no reads of a ring of {DEPTH}")
        self.clock = clock
        self.word_order, words = _words(registers)
        heads = words[:, 0].astype(np.int64)
        self.first, self.last = int(heads[0]), int(heads[-1])
        self.oldest = self.first - DEPTH - 1
        self.values = _unrolled(heads, words)
        self.start, self.period = _timing(heads, request, response)
        self.given = self.first
        self.reads = 0

    def count(self, now: float) -> int:
        """Samples written by now."""
        t = self.clock.recorded(now)
        due = self.first
        if t > -np.inf:
            due = self.last if t == np.inf else int(np.floor((t - self.start) / self.period)) + 1
        self.reads += 1
        self.given = max(self.given, min(due, self.last, self.given + DEPTH))
        return self.given

    def registers(self, now: float) -> list[int]:
        """The 64 registers now."""
        count = self.count(now)
        held = self.values[count - DEPTH - 1 - self.oldest : count - self.oldest]
        cells = np.zeros(DEPTH, np.int16)
        cells[np.arange(count - DEPTH, count) % DEPTH] = np.clip(np.diff(held), -32768, 32767)
        return packed(count, int(held[-1]), cells, self.word_order)


def _words(registers: NDArray[np.uint16]) -> tuple[str, NDArray[np.uint32]]:
    """Word order and the 32-bit words [polls, 32]: in the right order the count grows in small steps."""
    pairs = registers.reshape(len(registers), -1, 2).astype(np.uint32)
    orders = {"big": pairs[..., 0] << 16 | pairs[..., 1], "little": pairs[..., 1] << 16 | pairs[..., 0]}
    steps = {name: np.abs(np.diff(words[:, 0].astype(np.int64))).max() for name, words in orders.items()}
    order = min(steps, key=lambda name: int(steps[name]))
    return order, orders[order].astype(np.uint32)


def _unrolled(heads: NDArray[np.int64], words: NDArray[np.uint32]) -> NDArray[np.int64]:
    """Every sample from the one before the first read's oldest to the last read's newest; zero where a read came too
    late. ValueError where a read's newest sample is not the sum of what leads to it: that is another kind of ring.
    """
    first = int(heads[0]) - DEPTH - 1
    values, before = np.zeros(int(heads[-1]) - first, np.int64), None
    newest = words[:, 1].astype(np.uint32).view(np.int32)
    cells = words[:, 2:].astype(">u4").view(">i2").astype(np.int64)
    for head, last, row in zip(heads, newest, cells, strict=True):
        steps = row[np.arange(head - DEPTH, head) % DEPTH]
        held = int(last) - np.concatenate(([steps.sum()], steps.sum() - np.cumsum(steps)))
        if before is not None and head - before <= DEPTH and held[before - 1 - head] != values[before - 1 - first]:
            raise ValueError(f"the reads of samples {before - 1} and {head - 1} don't agree: no ring of differences")
        values[head - DEPTH - 1 - first : head - first], before = held, head
    return values


def _timing(heads: NDArray[np.int64], request: Float, response: Float) -> tuple[float, float]:
    """Time of sample 0 and period, s: the line that keeps farthest from what the reads exclude.

    A read that found h samples was asked before sample h was taken and answered after sample h - 1 was, however
    late its answer came; of the periods near the reads' own trend, that one counts which leaves the most room.
    """
    centre, first = float(request.mean()), float(heads.mean())
    h, asked, answered = heads - first, request - centre, response - centre
    trend = float(np.polyfit(h, asked, 1)[0])
    if trend <= 0:
        return centre - first / RING_RATE, 1.0 / RING_RATE
    slopes = trend * (1.0 + PPM * np.linspace(-SPREAD, SPREAD, 2 * SPREAD + 1))
    most = np.array([np.min(answered - slope * (h - 1.0)) for slope in slopes])
    least = np.array([np.max(asked - slope * h) for slope in slopes])
    best = int(np.argmax(most - least))
    slope = float(slopes[best])
    return float(most[best] + least[best]) / 2.0 + centre - slope * first, slope


class RecordedGauge(threading.Thread):
    """Plays a gauge: raw uint8 [bytes], arrival s [reads], size: bytes of each read. Every byte goes out, in order.

    answers: what it says to the host's commands before it plays; afterwards nothing but the recording is sent.
    """

    def __init__(
        self,
        terminal: Terminal,
        raw: NDArray[np.uint8],
        arrival: Float,
        size: NDArray[np.integer],
        clock: PlayClock,
        answers: Callable[[bytes], list[bytes]],
    ) -> None:
        super().__init__(name=str(terminal.port), daemon=True)
        self.terminal, self.clock, self.answers = terminal, clock, answers
        self.data, self.arrival = raw.tobytes(), arrival
        self.ends = np.cumsum(size).astype(np.int64)
        self.sent, self.held = 0, False
        self._ending = threading.Event()

    def run(self) -> None:
        """Until everything is out or `end`."""
        while not self._ending.is_set() and not self.clock.listening.wait(0.01):
            self._answer()
        for when, stop in zip(self.arrival, self.ends, strict=True):
            if self._ending.wait(max(0.0, self.clock.true(float(when)) - time.monotonic())):
                return
            self._send(int(stop))

    def _answer(self) -> None:
        self.held, asked = self.terminal.watched()
        if self.held and asked:
            for reply in self.answers(self.terminal.read()):
                self.terminal.write(reply)

    def _send(self, stop: int) -> None:
        while self.sent < stop and not self._ending.is_set():
            if self.terminal.watched()[0]:
                self.sent += self.terminal.write(self.data[self.sent : stop])
            if self.sent < stop:
                select.select([], [self.terminal.fileno()], [], 0.002)
                time.sleep(2e-4)
            if self.terminal.watched()[1]:
                os.read(self.terminal.fileno(), 4096)

    def end(self) -> None:
        """Stop and wait."""
        self._ending.set()
        if self.is_alive():
            self.join()
        self.terminal.disconnect()
