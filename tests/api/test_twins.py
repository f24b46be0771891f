"""The model beside a run: what it used and said ends up in the recording."""

from __future__ import annotations

import threading
from pathlib import Path

import h5py
import numpy as np

from api.twins import Beside, make_twin, store
from stand.clock import LiveBlock
from stand.setup import Setup


def test_a_twins_notes_are_kept_though_a_screen_reads_the_fresh_run_just_then(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file.create_group("entry")
    beside = Beside(lambda: make_twin("force", Setup()))
    time = np.arange(2000) / 2000.0
    still = np.zeros(2000)
    beside.push(LiveBlock(0, time, still, still, still + 15.2, np.zeros(2000, np.uint8), 1.0))
    assert beside.finish() is not None  # what it waits for must not be the reader's chance
    reader = h5py.File(path, "r")
    threading.Timer(0.4, reader.close).start()
    store(path, beside)
    with h5py.File(path) as file:
        assert file["entry/live"].attrs["model"] == "force"
        assert len(next(iter(file["entry/live"].values()))) == 2000
