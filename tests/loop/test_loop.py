"""Whole runs on the simulated stand: what is sent is kept, a kill or a fault stops the drive and keeps the file.

The measurements behind these (many kills, many trips, long runs) are the commands in this folder.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np
import pytest

from stand.excitation.plan import plan
from stand.excitation.spec import Excitation, Shape
from stand.recording import read_recording
from stand.runs import Finished, LiveBlock, Outcome, Phase, RunOrder, jog, rest_check, start, status
from tests.loop.kills import kill_once
from tests.loop.ledger import drive_truth
from tests.loop.simulated import Simulated, launch, simulated_stand
from tests.loop.soak import lost_samples
from tests.loop.trips import trip_once

SHAPES = [
    Excitation(Shape.RECTANGULAR, 1.0, 0.010, cycles=2),
    Excitation(Shape.TRAPEZOIDAL, 1.25, 0.030, 0.2, 2),
    Excitation(Shape.QUASI_SINUSOIDAL, 0.5, 0.040, cycles=1),
]


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Simulated]:
    with simulated_stand("--seed", "5", folder=tmp_path_factory.mktemp("stand")) as running:
        yield running


@pytest.mark.parametrize("excitation", SHAPES, ids=lambda e: str(e.shape))
def test_a_run_is_recorded_without_a_gap_and_told_live(
    simulated: Simulated, tmp_path: Path, excitation: Excitation
) -> None:
    handle = start(simulated.stand, RunOrder(excitation, folder=tmp_path, comment="a test"))
    events = list(handle.events())
    last = events[-1]
    assert isinstance(last, Finished), last
    assert last.outcome is Outcome.FINISHED, last.why
    assert last.path is not None
    phases = [event.name for event in events if isinstance(event, Phase)]
    assert phases == ["connect", "check", "prepare", "rest", "motion", "settle", "stop", "align", "done"]
    recording = read_recording(last.path)
    planned = plan(excitation, simulated.stand.limits)
    assert len(recording.time) == int(2000 * planned.duration + 1e-6)
    assert recording.complete
    assert recording.quality is not None
    assert not recording.quality.any()
    assert np.ptp(recording.x) > 0.9 * excitation.amplitude
    assert recording.F[:800].mean() == pytest.approx(15.2, abs=3.5)
    live = [event for event in events if isinstance(event, LiveBlock)]
    assert sum(len(block.time) for block in live) > 0.97 * len(recording.time)
    assert {name: lost for name, (_, lost) in lost_samples(last.path, simulated.ledger).items()} == {
        "force_gauge": 0,
        "dial_gauge": 0,
        "drive": 0,
    }
    with h5py.File(last.path) as file:
        origin = file["entry/data"].attrs["host_origin"]
        truth = drive_truth(simulated.ledger, origin + recording.time)
        assert np.std(recording.x - truth) < 30e-6  # its own figure is measured over fifty seeds elsewhere
        assert file["entry/comment"][()] == b"a test"
        assert file["entry/events"].attrs["outcome"] == "finished"


@pytest.mark.parametrize("moment", ["motion", "close"])
def test_a_killed_acquisition_leaves_its_file_and_a_stopped_drive(
    simulated: Simulated, tmp_path: Path, moment: str
) -> None:
    assert kill_once(simulated, tmp_path, moment, random.Random(3)).wrong == ""


def test_a_force_above_its_limit_stops_the_drive_at_once_and_keeps_the_run(
    simulated: Simulated, tmp_path: Path
) -> None:
    trip = trip_once(simulated, tmp_path, 0.3)
    assert trip.from_sample < 0.05  # the 99th percentile on a quiet machine is another command's business
    assert trip.finished.path is not None
    recording = read_recording(trip.finished.path)
    assert recording.quality is not None
    assert recording.quality[-1] & 8
    assert "force" in trip.finished.why
    assert simulated.statusword() & 0x6F != 0x27, "the drive is still enabled"


def test_the_stand_can_be_looked_at_and_prepared_without_a_run(simulated: Simulated) -> None:
    found = status(simulated.stand)
    assert {name: found[name]["state"] for name in ("drive", "force_gauge", "dial_gauge")} == {  # type: ignore[index]
        "drive": "ok",
        "force_gauge": "ok",
        "dial_gauge": "ok",
    }
    before = found["drive_status"]["travel"]  # type: ignore[index]
    assert jog(simulated.stand, 0.002) == pytest.approx(before + 0.002, abs=2e-4)
    assert jog(simulated.stand, -0.002) == pytest.approx(before, abs=2e-4)
    assert rest_check(simulated.stand).ok


@pytest.mark.parametrize("speed", [pytest.param("1", marks=pytest.mark.slow), "max"])
def test_a_replay_through_devices_gives_the_same_bytes_and_with_its_arrivals_the_same_grid(
    simulated: Simulated, tmp_path: Path, speed: str
) -> None:
    first = start(simulated.stand, RunOrder(SHAPES[1], folder=tmp_path, name="first")).wait()
    assert isinstance(first, Finished), first
    assert first.path is not None
    played = launch(["replay", str(first.path), "--speed", speed], tmp_path / "none")
    pace = 0.0 if speed == "max" else float(speed)
    order = RunOrder(SHAPES[1], folder=tmp_path, name="again", replay=True, speed=pace, inject=first.path)
    again = start(played.stand, order).wait()
    played.close()
    assert isinstance(again, Finished), again
    assert again.path is not None
    with h5py.File(first.path) as one, h5py.File(again.path) as two:
        for name in ("time", "drive_position", "weight_position", "fibre_force", "quality"):
            assert np.array_equal(one["entry/data"][name][()], two["entry/data"][name][()]), name
        for name in ("force_gauge", "dial_gauge"):
            assert np.array_equal(
                one[f"entry/instruments/{name}/values"][()], two[f"entry/instruments/{name}/values"][()]
            )
