"""The model that runs beside an experiment."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stand.setup import Setup
    from twin.live import LiveTwin

#: one thread at a time imports and compiles a model
_MAKING = threading.Lock()
#: how long a reader of a fresh recording may keep its twin's notes waiting, s
PATIENCE = 10.0


def make_twin(name: str, setup: Setup) -> LiveTwin:
    """A live twin of the model `name` (of `stand models`, or an extended model's file), compiled and ready."""
    from api.catalogue import find_model

    with _MAKING:
        from twin.live import LiveTwin

        model, parameters, setup = find_model(name, setup)
        return LiveTwin(setup, model, parameters)


def store(path: Path, twin: LiveTwin | None) -> None:
    """Keep what the twin used and said in the recording, `/entry/live`."""
    from twin.live import store_live

    if twin is None:
        return
    end = time.monotonic() + PATIENCE
    while True:
        try:
            store_live(path, twin)
            return
        except BlockingIOError:  # somebody reads the file just now, and HDF5 locks it
            if time.monotonic() > end:
                raise
            time.sleep(0.1)
