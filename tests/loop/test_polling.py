"""A run whose drive has no counted ring: plainly polled, through function 43/13, and labelled derived."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest

from stand.excitation.spec import Excitation, Shape
from stand.recording import read_recording
from stand.runs import Finished, LiveBlock, Outcome, RunOrder, start
from tests.loop.ledger import drive_truth
from tests.loop.simulated import simulated_stand

PROFILE = """
[profile]
name = "plain"
vendor = "nobody"
source = "this test"
[encoding]
backend = "mei13"
[units]
position = { scale = 1.0, unit = "um" }
velocity = { scale = 1.0, unit = "um/s" }
acceleration = { scale = 1.0, unit = "um/s^2" }
"""
MOTION = Excitation(Shape.TRAPEZOIDAL, 1.25, 0.030, 0.2, cycles=1)


@pytest.mark.slow
def test_a_drive_without_a_ring_is_recorded_from_its_polls_and_says_that_it_is_derived(tmp_path: Path) -> None:
    (tmp_path / "plain.toml").write_text(PROFILE)
    with simulated_stand("--seed", "5", folder=tmp_path) as simulated:
        stand = simulated.stand
        drive = stand.drive.model_copy(update={"profile": str(tmp_path / "plain.toml"), "stale": 1.0})
        handle = start(stand.model_copy(update={"drive": drive}), RunOrder(MOTION, folder=tmp_path, name="polled"))
        events = list(handle.events())
        last = events[-1]
        assert isinstance(last, Finished), last
        assert last.outcome is Outcome.FINISHED, last.why
        assert last.path is not None
        recording = read_recording(last.path)
        with h5py.File(last.path) as file:
            origin = file["entry/data"].attrs["host_origin"]
            assert "drive" in file["entry/data"].attrs["derived"]
            assert "derived" in file["entry/instruments/drive/sampling"][()].decode()
        deviation = recording.x - drive_truth(simulated.ledger, origin + recording.time)
    assert np.ptp(recording.x) == pytest.approx(0.030, abs=0.003)
    assert np.std(deviation) < 200e-6  # 0.3 m/s, and polls that take a millisecond
    live = [event for event in events if isinstance(event, LiveBlock)]
    assert sum(len(block.time) for block in live) > 0.9 * len(recording.time)
    shown = np.concatenate([block.x for block in live])
    assert np.ptp(shown) == pytest.approx(0.030, abs=0.004)
