"""The model that runs beside an experiment."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from api.blocks import joined
from stand.errors import StandError

if TYPE_CHECKING:
    from stand.clock import LiveBlock
    from stand.setup import Setup
    from twin.live import LiveScore, LiveTwin

#: one thread at a time imports and compiles a model
_MAKING = threading.Lock()
#: how long a reader of a fresh recording may keep its twin's notes waiting, s
PATIENCE = 10.0
#: how long after a run a twin that still compiles is waited for, s
COMPILING = 90.0


def make_twin(name: str, setup: Setup) -> LiveTwin:
    """A live twin of the model `name` (of `stand models`, or an extended model's file), compiled and ready."""
    from api.catalogue import find_model

    with _MAKING:
        from twin.live import LiveTwin

        model, parameters, setup = find_model(name, setup)
        return LiveTwin(setup, model, parameters)


class Beside:
    """A twin that is made while the run begins: what comes before it is ready waits, and is caught up with.

    make: gives the twin; may compile for a minute on the very first run. note: why there is none, in words.
    """

    def __init__(self, make: Callable[[], LiveTwin]) -> None:
        self.note, self._twin = "", None
        self._waiting: list[LiveBlock] = []
        self._thread = threading.Thread(target=self._make, args=(make,), name="twin", daemon=True)
        self._thread.start()

    _twin: LiveTwin | None

    def _make(self, make: Callable[[], LiveTwin]) -> None:
        try:
            self._twin = make()
        except Exception as error:
            self.note = f"no twin beside this run: {error}"

    def push(self, block: LiveBlock) -> LiveScore | None:
        """The score after this block; None while the twin is being made, or without one."""
        if self.note:
            return None
        self._waiting.append(block)
        if self._thread.is_alive() or self._twin is None:
            return None
        block = joined(self._waiting)
        self._waiting.clear()
        try:
            return self._twin.push(block.time, block.x, block.u, block.F)
        except StandError as error:
            self.note, self._twin = f"the twin gave up: {error}", None
            return None

    def finish(self) -> LiveTwin | None:
        """The twin with all that came, waiting for one that still compiles; None where it gave up."""
        self._thread.join(COMPILING)
        if self._waiting and self._twin is not None:
            self.push(self._waiting.pop())
        return self._twin


def store(path: Path, beside: Beside | None) -> None:
    """Keep what the twin used and said in the recording, `/entry/live`; OSError where the file can't be written."""
    from twin.live import store_live

    twin = beside.finish() if beside is not None else None
    if twin is None:
        return
    end = time.monotonic() + PATIENCE
    while True:
        try:
            store_live(path, twin)
            return
        except OSError:  # somebody reads the file just now, another process (HDF5 locks it) or a thread of this one
            if time.monotonic() > end:
                raise
            time.sleep(0.1)
