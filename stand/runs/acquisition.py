"""Readers, safety, recorder and live tap put together: the way of every block, one hop a line in `take`."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Mapping
from typing import Protocol

import numpy.ma  # noqa: F401  numpy loads it at the first median, which would hold up every reader for 70 ms

from stand.block import Block
from stand.clock import LiveAligner, LiveBlock
from stand.config import Stand
from stand.drive.profile import load_profile
from stand.errors import StandError
from stand.recorder import Happening, Recorder, Taken
from stand.runs.health import Meter
from stand.runs.messages import Health
from stand.safety import Supervisor
from stand.transport.poll_reader import PollReader
from stand.transport.raw import Raw
from stand.transport.readers import GaugeReader, RingReader

GAUGES = ("force_gauge", "dial_gauge")
#: s that the live thread lets blocks gather: woken by each, it would hold up the readers
GATHER = 0.004


class Reader(Protocol):
    """One instrument's way in."""

    def open(self) -> None: ...
    def identify(self) -> dict[str, str]: ...
    def start(self, sink: Callable[[Raw, Block | None], None], on_error: Callable[[str, Exception], None]) -> None: ...
    def stop(self) -> None: ...
    def close(self) -> None: ...


def make_readers(stand: Stand) -> dict[str, Reader]:
    """A reader for each instrument of the stand; the drive's last: a replay begins when it is asked."""
    readers: dict[str, Reader] = {name: GaugeReader(name, getattr(stand, name)) for name in GAUGES}
    ring = load_profile(stand.drive.profile).trace.kind == "ring"
    return readers | {"drive": RingReader(stand) if ring else PollReader(stand)}


class Acquisition:
    """All streams at work. Every thread here only hands over; nothing waits for a slower one.

    publish: gets the live blocks and the health, must not block. on_lost: told which link was lost, and how.
    """

    def __init__(
        self,
        stand: Stand,
        readers: Mapping[str, Reader],
        supervisor: Supervisor,
        publish: Callable[[LiveBlock | Health], None],
        on_lost: Callable[[str, str], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._stand, self._readers, self._supervisor, self._publish = stand, readers, supervisor, publish
        self._on_lost = on_lost
        self._clock, self._recorder, self._aligner = clock, None, None
        self._live: queue.SimpleQueue[Block | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._serve_live, name="live", daemon=True)
        self.meters = {name: Meter(stand.instruments[name].stale) for name in readers}
        self.reading = False

    _recorder: Recorder | None
    _aligner: LiveAligner | None

    def start(self) -> None:
        """Start every reader."""
        self._thread.start()
        self.reading = True
        for reader in self._readers.values():
            reader.start(self.take, self.lost)

    def record(self, recorder: Recorder) -> None:
        """From here on everything goes to the recorder, too."""
        self._recorder = recorder

    def align_from(self, origin: float) -> None:
        """The live grid's sample 0 is at this host time."""
        self._aligner = LiveAligner(self._stand, origin)

    def stop(self) -> None:
        """End the readers and the live thread; what has been read has been handed over."""
        self.reading = False
        for reader in self._readers.values():
            reader.stop()
        self._live.put(None)
        if self._thread.is_alive():
            self._thread.join(2.0)

    def take(self, raw: Raw, block: Block | None) -> None:
        """One read, in its reader's thread."""
        if block is not None and len(block):
            self._supervisor.look(block)
        if self._recorder is not None:
            self._recorder.put(Taken(raw, block))
        if block is not None and len(block):
            self.meters[block.instrument].count(block)
            self._live.put(block)

    def lost(self, instrument: str, error: Exception) -> None:
        """A reader lost its link, in its own thread."""
        if not self.reading:
            return
        self.meters[instrument].lost = True
        self.note("lost", f"{instrument}: {error}")
        self._on_lost(instrument, error.what if isinstance(error, StandError) else str(error))

    def note(self, kind: str, text: str) -> None:
        """A line for `/entry/events`."""
        if self._recorder is not None:
            self._recorder.put(Happening(self._clock(), kind, text))

    def _serve_live(self) -> None:
        told = self._clock()
        while (block := self._live.get()) is not None:
            aligner = self._aligner
            aligned = aligner.push(block) if aligner is not None else None
            if aligned is not None:
                if self._recorder is not None:
                    self._recorder.put(aligned)
                self._publish(aligned)
            now = self._clock()
            if now - told >= 1.0:
                told = now
                self._publish(Health(now, {name: meter.read(now) for name, meter in self.meters.items()}))
            if self._live.empty():
                time.sleep(GATHER)
