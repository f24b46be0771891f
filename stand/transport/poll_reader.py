"""A reader for drives without a counted ring: position and velocity polled, what lies between them interpolated."""

from __future__ import annotations

import random
import time

import numpy as np

from stand.block import Block
from stand.clock.polls import hermite, pack_poll
from stand.config import Stand
from stand.drive.backends import make_backend
from stand.drive.profile import load_profile
from stand.errors import StandError
from stand.transport.link import Clock, ModbusLink
from stand.transport.priority import raise_priority
from stand.transport.raw import RawRegisters
from stand.transport.readers import OnError, Sink
from stand.transport.worker import Worker


class PollReader:
    """Position and velocity polled one by one. The raw polls are what was measured.

    The blocks are a cubic through two neighbouring polls at the drive's nominal rate, for limits and screens; the
    channel is labelled derived.
    """

    def __init__(self, stand: Stand, clock: Clock = time.monotonic, seed: int | None = None) -> None:
        self.instrument = "drive"
        self.profile = load_profile(stand.drive.profile)
        self._link, self._clock = ModbusLink(stand.drive.link, clock), clock
        self._backend = make_backend(self.profile, self._link)
        self._rate, self._direction = stand.drive.rate, stand.drive.direction
        self._scales = self.profile.units.si("position"), self.profile.units.si("velocity")
        self._before: tuple[float, float, float] | None = None
        self._base = 0
        self._period, self._random = 1.0 / stand.drive.poll_rate, random.Random(seed)
        self._worker = Worker("polls")

    def open(self) -> None:
        """Connect."""
        self._link.open()

    def close(self) -> None:
        """Stop polling and disconnect; harmless twice."""
        self.stop()
        self._link.close()

    def identify(self) -> dict[str, str]:
        """How the channel is sampled."""
        return {"profile": self.profile.profile.name, "trace": "plain polling, derived"}

    def poll(self) -> RawRegisters:
        """One poll now."""
        request = self._clock()
        position = self._backend.read("position")
        response = self._clock()
        velocity = self._backend.read("velocity") if self._backend.has("velocity") else 0
        return RawRegisters(self.instrument, pack_poll(position, velocity), request, response)

    def samples(self, raw: RawRegisters) -> Block | None:
        """What lies between the last poll and this one, at the nominal rate; None where there is nothing yet."""
        position, velocity = np.ascontiguousarray(raw.registers).astype(">u2").view(">i4").tolist()
        here = (raw.request + raw.response) / 2
        now = (here, self._direction * self._scales[0] * position, self._direction * self._scales[1] * velocity)
        before, self._before = self._before, now
        if before is None:
            self._base = int(here * self._rate) + 1
            return None
        first, end = int(before[0] * self._rate) + 1, int(here * self._rate) + 1
        if end <= first:
            return None
        times = np.arange(first, end) / self._rate
        (t, x, v) = (np.array(pair) for pair in zip(before, now, strict=True))
        values, flags = hermite(t, x, v, times), np.zeros(len(times), np.uint8)
        return Block(self.instrument, first - self._base, values, None, flags, raw.response, request=raw.request)

    def start(self, sink: Sink, on_error: OnError) -> None:
        """Poll from now on, in a thread."""
        self._before = None
        self._worker.start(self._run, sink, on_error)

    def stop(self) -> None:
        """End the thread; harmless twice."""
        self._worker.stop()

    def _run(self, sink: Sink, on_error: OnError) -> None:
        raise_priority()
        try:
            while not self._worker.stopping.is_set():
                raw = self.poll()
                sink(raw, self.samples(raw))
                self._worker.stopping.wait(self._period * self._random.uniform(0.8, 1.1))
        except StandError as error:
            if not self._worker.stopping.is_set():
                on_error(self.instrument, error)
