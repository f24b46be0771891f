"""A streaming gauge: samples on its own clock, its frames on the line, bytes handed over in their time."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from time import monotonic
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mocks.devices.clock import DeviceClock
from mocks.devices.kernels import digitise, sample_times
from mocks.ledger import DROPPED, FAULTY, OVERRUN, SPOILT, Rows
from mocks.wire.line import Adapter, Line
from mocks.wire.terminal import Terminal

Float = NDArray[np.float64]

#: s that handing over takes at least
WRITING = 5e-6


class Head(Protocol):
    """What makes one kind of gauge: samples to frames, and its answers to what the host sends."""

    frame_bytes: int

    def encode(self, values: Float, faulty: NDArray[np.bool_]) -> tuple[NDArray[np.uint8], Float]:
        """Frames [n, frame_bytes] and the values that a reader will get."""
        ...

    def answers(self, data: bytes, gauge: Gauge) -> list[bytes]:
        """Answers to what the host sent."""
        ...


@dataclass
class Sensing:
    """How the gauge measures. noise, step: sigma and quantum; zero: what it shows at the plant's zero;
    conversion: s from the sample to its frame's first bit; limit: values beyond are faulty."""

    noise: float
    step: float
    zero: float
    conversion: float
    limit: float


@dataclass
class Trouble:
    """What is wrong with the gauge at present; times are true times up to which it lasts."""

    drop: int = 0
    corrupt: int = 0
    silent: float = -np.inf
    faulty: float = -np.inf
    spike: float = -np.inf
    spike_value: float = 0.0
    broken: float = -np.inf


@dataclass
class Gauge:
    """signal: values at true times [n] as sensed and as they are. batch: frames handed over at once (no timer)."""

    name: str
    head: Head
    terminal: Terminal
    clock: DeviceClock
    sensing: Sensing
    line: Line
    adapter: Adapter
    signal: Callable[[Float], tuple[Float, Float]]
    rng: np.random.Generator
    log: Callable[[Rows], None]
    rate: float = 2000.0
    batch: int = 4
    streaming: bool = True
    host_time: Callable[[], float] = monotonic
    trouble: Trouble = field(default_factory=Trouble)
    counter: int = 0
    tick: int = 0
    newest: float = 0.0
    tare: float = 0.0
    wake: float = -np.inf
    release: float = -np.inf
    delay: float = 0.0
    _way: list[Rows] = field(default_factory=list)
    _queued: int = 0
    _gone: int = 0
    _sent: tuple[int, int, float] | None = None

    @property
    def latency(self) -> float:
        """From a sample to the last byte of its frame in the host's hands at the earliest, s."""
        wire = self.head.frame_bytes * self.line.byte_time
        return self.sensing.conversion + wire + self.adapter.jitter[0]

    @property
    def foresight(self) -> float:
        """How long before the next hand-over its bytes can be made, s: all are sampled, and nothing else will leave.

        A timer cuts frames: there the first byte of a frame counts, else the whole one.
        """
        wire = (1 if self.adapter.timer else self.head.frame_bytes) * self.line.byte_time
        return self.sensing.conversion + wire + self.delay

    def prepare(self, now: float) -> None:
        """Sample up to `now`, to which the plant has come; answer the host. Nothing leaves here."""
        held, asked = self._watch(now)
        if asked:
            for reply in self.head.answers(self.terminal.read(), self):
                self._queued += len(reply)
                self.line.put(reply, now)
        self._sample(now, held)
        if not held:
            self._forget()

    def hand_over(self, now: float) -> None:
        """What is due leaves; `wake` then says when to come again."""
        self.send(now)
        self.book(now)

    def send(self, now: float) -> None:
        """What is due leaves, and nothing else is done: others may be due, too."""
        if now >= self.wake - WRITING:
            data = self.line.take(self.release if self.adapter.timer else max(now, self.wake) - self.delay)
            written = self.terminal.write(data) if data else 0
            self._sent = len(data), written, self.host_time()

    def book(self, now: float) -> None:
        """What has just been sent is noted, and planned when to come again."""
        if self._sent is not None:
            size, written, handed = self._sent
            self._sent, end = None, self._gone + written
            self._gone += size
            self._settle(end, handed)
            self._plan(now)

    def _watch(self, now: float) -> tuple[bool, bool]:
        if now < self.trouble.broken:
            self.terminal.disconnect()
        else:
            self.terminal.connect()
        return self.terminal.watched()

    def _sample(self, now: float, held: bool) -> None:
        first, last = self.tick, math.floor(self.clock.device(now) * self.rate)
        if last < first:
            return
        self.tick = last + 1
        act = self._measure if self.streaming and held else self._miss
        act(first, last + 1 - first)

    def _times(self, first: int, count: int) -> tuple[Float, Float]:
        """The device's and the true times of its samples."""
        tick, time = np.empty((2, count))
        sample_times(first, self.rate, self.clock.epoch, self.clock.drift, tick, time)
        return tick, time

    def _miss(self, first: int, count: int) -> None:
        _, due = self._times(first + count - 1, 1)
        self.newest = float(self._read(due, np.empty(1, np.bool_))[0][0])
        self.counter += count

    def _read(self, times: Float, faulty: NDArray[np.bool_]) -> tuple[Float, Float, bool]:
        """What the gauge reads, the truth in its own zero, and whether some of it is marked as faulty."""
        s = self.sensing
        sensed, true = self.signal(times)
        zero, values, trouble = s.zero - self.tare, self.rng.standard_normal(len(times)), self.trouble
        spike = trouble.spike, trouble.spike_value
        limits = s.limit, trouble.faulty
        some = digitise(sensed, times, s.noise, zero, s.step, *spike, *limits, values, faulty)
        return values, true + zero, some

    def _measure(self, first: int, count: int) -> None:
        tick, times = self._times(first, count)
        faulty = np.empty(count, np.bool_)
        values, true, some = self._read(times, faulty)
        frames, told = self.head.encode(values, faulty)
        self.newest = float(told[-1])
        rows = Rows.of(np.arange(self.counter, self.counter + count), tick, times, told, true)
        self.counter += count
        if some:
            rows.clean = False
            rows.flags[faulty] |= FAULTY
        self._queue(rows, self._spoil(frames, rows))

    def _spoil(self, frames: NDArray[np.uint8], rows: Rows) -> NDArray[np.uint8]:
        trouble = self.trouble
        for k in range(len(frames) if trouble.drop or trouble.corrupt else 0):
            rows.clean = False
            if trouble.drop > 0:
                trouble.drop -= 1
                rows.flags[k] |= DROPPED
            elif trouble.corrupt > 0:
                trouble.corrupt -= 1
                rows.flags[k] |= SPOILT
                frames[k, self.rng.integers(self.head.frame_bytes)] ^= 0xFF
        if rows.true_time[0] < trouble.silent:
            rows.clean = False
            rows.flags[rows.true_time < trouble.silent] |= DROPPED
        return frames

    def _queue(self, rows: Rows, frames: NDArray[np.uint8]) -> None:
        ready = rows.true_time + self.sensing.conversion
        if rows.clean:
            rows.due[:] = self.line.put_frames(frames, ready)
            rows.place[:] = self._queued + self.head.frame_bytes * np.arange(1, len(rows) + 1)
        else:
            kept = rows.flags & DROPPED == 0
            if kept.any():
                rows.due[kept] = self.line.put_frames(frames[kept], ready[kept])
            rows.place[:] = self._queued + self.head.frame_bytes * np.cumsum(kept)
        self._queued = int(rows.place[-1])
        self._way.append(rows)

    def _settle(self, end: int, handed: float) -> None:
        """Book the frames whose last byte went out, or was lost because the host's buffer was full."""
        while self._way:
            rows = self._way[0]
            count = len(rows)
            if rows.place[-1] > self._gone:
                count = int(np.searchsorted(rows.place, self._gone, side="right"))
                if count == 0:
                    return
                rows, rest = rows.split(count)
                self._way[0] = rest
            else:
                del self._way[0]
            self._book(rows, end, handed)

    def _book(self, rows: Rows, end: int, handed: float) -> None:
        rows.handed[:] = handed
        if rows.place[-1] > end:
            rows.clean = False
            rows.flags[(rows.place > end) & (rows.flags & DROPPED == 0)] |= OVERRUN
        if not rows.clean:
            rows.handed[rows.flags & (DROPPED | OVERRUN) != 0] = np.nan
        self.log(rows)

    def _forget(self) -> None:
        self.line.clear()
        self._way.clear()
        self._gone = self._queued

    def _plan(self, now: float) -> None:
        """When the next bytes are to be handed over: after some whole frames, or with the adapter's tick."""
        self.delay = self.adapter.delay()
        if self.adapter.timer:
            self.release = float(self.adapter.tick_after(max(now, self.release)))
            self.wake = self.release + self.delay
            return
        period = 1.0 / self.rate
        first = self.clock.moment(self.tick * period)
        ready = first + (self.batch - 1) * period + self.sensing.conversion
        self.wake = max(ready + self.head.frame_bytes * self.line.byte_time + self.delay, now + 1e-4)

    def set_streaming(self, on: bool) -> None:
        """Start or stop the stream."""
        self.streaming = on

    def set_rate(self, rate: float | None) -> float:
        """A new sample rate in Hz, from now on; ValueError where the line can't carry it. Returns the rate."""
        if rate is not None and rate != self.rate:
            if not 0.0 < rate * self.head.frame_bytes * self.line.byte_time <= 1.0:
                raise ValueError(f"{rate} Hz needs more than the line's {1.0 / self.line.byte_time:.0f} bytes a second")
            start = self.clock.moment(self.tick / self.rate)
            self.clock, self.tick, self.rate = self.clock.rebased(start), 0, rate
        return self.rate

    def set_zero(self) -> None:
        """Take the present value as zero."""
        self.tare += self.newest
        self.newest = 0.0
