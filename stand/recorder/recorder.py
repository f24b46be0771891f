"""The live recorder: one thread owns the file, everyone else only puts into its queue, which never drops."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np

from stand.block import Block
from stand.clock.model import LiveBlock
from stand.errors import StandError
from stand.recorder.layout import FilePlan, Layout, create_layout, mark_start
from stand.recorder.raw import Happening, Taken
from stand.recording.model import CHANNELS
from stand.transport.raw import RawBytes, RawRegisters

FLUSH = 0.2
#: s between looks into the queue: woken by every block, a thread would cost what it writes many times over
PAUSE = 0.02


Item = Taken | Happening | LiveBlock


class Recorder:
    """Writes what it is given to `path` and flushes every `flush` s; the file must not exist before.

    After `close` the file holds everything given, uncompressed, and is not yet complete: see `finish_file`.
    """

    def __init__(
        self, path: Path, plan: FilePlan, *, flush: float = FLUSH, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.path, self._plan, self._period, self._clock = path, plan, flush, clock
        self._queue: queue.SimpleQueue[Item | None] = queue.SimpleQueue()
        self._ready, self._thread = threading.Event(), threading.Thread(target=self._serve, name="recorder")
        self.error: BaseException | None = None

    def start(self) -> None:
        """Create the file with all its objects; StandError where that fails."""
        self._thread.start()
        self._ready.wait()
        self._check()

    def put(self, item: Item) -> None:
        """Hand over an item; never blocks, never drops."""
        self._queue.put(item)

    def close(self) -> None:
        """Write everything given so far, close the file; StandError where writing failed on the way."""
        self._queue.put(None)
        self._thread.join()
        self._check()

    def _check(self) -> None:
        if self.error is not None:
            remedy = "Check the folder, its free space and its rights"
            raise StandError(f"recording failed: {self.error}", where=str(self.path), remedy=remedy) from self.error

    def _serve(self) -> None:
        try:
            with h5py.File(self.path, "x", rdcc_nbytes=0) as file:
                layout = create_layout(file, self._plan)
                file.flush()
                self._ready.set()
                self._record(file, layout)
        except BaseException as error:
            self.error = error
            self._ready.set()

    def _record(self, file: h5py.File, layout: Layout) -> None:
        going, channels = True, [c.name for c in CHANNELS[self._plan.setup.system]]
        if (item := self._queue.get()) is None:
            return
        mark_start(file)
        _add(layout, item, channels)
        while going:
            going = self._collect(layout, channels, self._clock() + self._period)
            layout.store()
            _count(layout)
            file.flush()

    def _collect(self, layout: Layout, channels: list[str], until: float) -> bool:
        """Take items until `until`; False once the end was taken."""
        while (left := until - self._clock()) > 0:
            try:
                item = self._queue.get_nowait()
            except queue.Empty:
                time.sleep(min(left, PAUSE))
                continue
            if item is None:
                return False
            _add(layout, item, channels)
        return True


def _add(layout: Layout, item: Item, channels: list[str]) -> None:
    if isinstance(item, Taken):
        _add_raw(layout, item)
        if item.block is not None:
            _add_block(layout, item.block)
    elif isinstance(item, Happening):
        layout.events["host_time"].add(np.array([item.at]))
        for name, text in (("kind", item.kind), ("text", item.text)):
            layout.events[name].add(np.array([_fit(text)], dtype="S240"))
    else:
        _add_grid(layout, item, channels)


def _count(layout: Layout) -> None:
    for name, counters in layout.counters.items():
        counters["frames_counted"][()] = layout.streams[name]["values"].dataset.shape[0]


def _fit(text: str) -> bytes:
    """At most 240 bytes of whole UTF-8 characters."""
    return text.encode()[:240].decode(errors="ignore").encode()


def _add_raw(layout: Layout, item: Taken) -> None:
    raw, series = item.raw, layout.streams[item.raw.instrument]
    if isinstance(raw, RawBytes):
        series["raw"].add(np.frombuffer(raw.data, np.uint8))
        series["arrival_time"].add(np.array([raw.arrival]))
        series["arrival_bytes"].add(np.array([len(raw.data)], np.uint32))
    elif isinstance(raw, RawRegisters):
        series["registers"].add(raw.registers[np.newaxis])
        series["request_time"].add(np.array([raw.request]))
        series["response_time"].add(np.array([raw.response]))


def _add_block(layout: Layout, block: Block) -> None:
    series = layout.streams[block.instrument]
    # the recording may have begun in the middle of a frame, of which its raw bytes hold only the end
    begin = 1 if "raw" in series and block.span > len(series["raw"]) else 0
    series["values"].add(block.values[begin:])
    series["flags"].add(block.flags[begin:])
    if "ticks" in series and block.ticks is not None:
        series["ticks"].add(block.ticks)


def _add_grid(layout: Layout, block: LiveBlock, channels: list[str]) -> None:
    letters = {"drive_position": block.x, "weight_position": block.u, "fibre_force": block.F}
    layout.data["time"].add(block.time)
    layout.data["quality"].add(block.quality)
    for name in channels:
        layout.data[name].add(letters[name])
