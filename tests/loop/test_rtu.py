"""A whole run whose drive is on a serial bus: control, ring and quick stop share two wires, a telegram at a time."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np
import pytest

from mocks.ledger import read_events
from stand.config import DEFAULT, Stand, load_stand_text
from stand.excitation.spec import Excitation, Shape
from stand.recording import read_recording
from stand.runs import Finished, LiveBlock, Outcome, RunOrder, start
from tests.loop.ledger import drive_truth
from tests.loop.simulated import Simulated, simulated_stand
from tests.loop.soak import lost_samples

BAUD = 460_800
MOTION = Excitation(Shape.TRAPEZOIDAL, 1.25, 0.030, 0.2, cycles=1)


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Simulated]:
    folder = tmp_path_factory.mktemp("rtu")
    (folder / "stand.toml").write_text(f"[drive]\nrtu_baud = {BAUD}\n")
    with simulated_stand(str(folder / "stand.toml"), "--seed", "5", folder=folder) as running:
        yield running


@pytest.fixture
def stand(simulated: Simulated) -> Stand:
    """The nominal stand whose file puts the drive on a serial bus, on this simulated one's ports."""
    text, found = re.subn(r'link = \{ kind = "tcp".*\}', 'link = { kind = "rtu", port = "x" }', DEFAULT.read_text())
    assert found == 1
    stand = load_stand_text(text).with_links(simulated.announcement)
    return stand.model_copy(
        update={"drive": stand.drive.model_copy(update={"stale": 1.0})}
    )  # a busy machine is no fault


def test_a_run_on_the_serial_bus_homes_moves_and_is_recorded(
    simulated: Simulated, stand: Stand, tmp_path: Path
) -> None:
    last = start(stand, RunOrder(MOTION, folder=tmp_path, home=True)).wait()
    assert isinstance(last, Finished), last
    assert last.outcome is Outcome.FINISHED, last.why
    assert last.path is not None
    recording = read_recording(last.path)
    assert recording.quality is not None
    there = recording.quality == 0
    assert np.mean(there) > 0.9
    assert np.ptp(recording.x[there]) == pytest.approx(0.030, abs=0.006)
    lost = {name: count for name, (_, count) in lost_samples(last.path, simulated.ledger).items()}
    assert lost["force_gauge"] == lost["dial_gauge"] == 0
    with h5py.File(last.path) as file:
        drive, origin = file["entry/instruments/drive"], file["entry/data"].attrs["host_origin"]
        assert "Modbus RTU at 460800 baud" in drive["sampling"][()].decode()
        assert drive["frames_lost"][()] == lost["drive"], "a sample that the ring lost is not counted"
        times = drive["response_time"][()]
        assert (len(times) - 1) / (times[-1] - times[0]) > 30, "polls a second"
    deviation = recording.x - drive_truth(simulated.ledger, origin + recording.time)
    assert np.std(deviation[there]) < 150e-6  # a poll's bracket is some 1.5 ms on this wire, the speed 0.2 m/s
    modes = [event["value"] for event in read_events(simulated.ledger) if event["kind"] == "mode"]
    assert 6 in modes, "the drive never was in its homing mode"


@pytest.mark.slow
def test_a_force_above_its_limit_stops_the_drive_on_the_same_bus(
    simulated: Simulated, stand: Stand, tmp_path: Path
) -> None:
    handle = start(stand, RunOrder(MOTION, folder=tmp_path, name="tripped"))
    for event in handle.events():
        if isinstance(event, LiveBlock) and event.time[-1] > 1.1:
            simulated.control("spike force_gauge 1500 0.02")
            break
    last = handle.wait()
    assert isinstance(last, Finished), last
    assert last.outcome is Outcome.TRIPPED
    assert "force" in last.why
    assert simulated.statusword() & 0x6F != 0x27, "the drive is still enabled"
