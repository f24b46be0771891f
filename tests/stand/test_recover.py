"""A file that a killed acquisition left behind, redone from its raw streams."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest

from api.cli import run
from stand.clock import GaugeStream, RingStream
from stand.errors import InputError
from stand.recorder import FilePlan, Happening, Recorder, Taken
from stand.recording import read_recording
from stand.recording.recover import recover
from stand.runs.streams import stream_specs
from stand.transport.raw import RawBytes, RawRegisters
from tests.stand.wires import Wires, draw


def left_behind(path: Path, wires: Wires, seconds: float) -> Path:
    """The file as it is when the acquisition dies after `seconds`: raw streams, nothing aligned."""
    plan = FilePlan(stream_specs(wires.stand, {}), wires.stand.setup, None, wires.stand.to_toml(), seconds)
    recorder = Recorder(path, plan)
    recorder.start()
    recorder.put(Happening(wires.origin, "origin", repr(wires.origin)))
    for name, stream in wires.streams.items():
        for raw in _reads(name, stream):
            if (raw.arrival if isinstance(raw, RawBytes) else raw.response) < wires.origin + seconds:
                recorder.put(Taken(raw, None))
    recorder.close()
    return path


def _reads(name: str, stream: GaugeStream | RingStream) -> list[RawBytes | RawRegisters]:
    if isinstance(stream, RingStream):
        return [
            RawRegisters(name, *read)
            for read in zip(stream.registers, stream.request_time, stream.response_time, strict=True)
        ]
    ends = np.cumsum(stream.arrival_bytes)
    parts = zip(ends - stream.arrival_bytes, ends, stream.arrival_time, strict=True)
    return [RawBytes(name, bytes(stream.raw[a:b]), float(t)) for a, b, t in parts]


@pytest.fixture(scope="module")
def abandoned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return left_behind(tmp_path_factory.mktemp("runs") / "run.h5", draw(1), 3.0)


def test_a_cut_off_file_is_redone_once_and_a_second_time_changes_nothing_and_says_so(
    abandoned: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    first = recover(abandoned)
    assert first.seconds == pytest.approx(3.0, abs=0.05)
    recording = read_recording(abandoned)
    assert recording.complete is False
    assert np.ptp(recording.x) > 0.02
    before = abandoned.read_bytes()
    again = recover(abandoned)
    assert again.seconds == again.seconds_before == first.seconds
    assert "nothing was changed" in again.guardian
    assert abandoned.read_bytes() == before
    assert run(["doctor", "--recover", str(abandoned)]) == 0
    assert "recovered before: nothing was changed" in capfd.readouterr().out


def test_a_file_without_raw_streams_is_refused_with_the_reason(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "foreign.h5", "w") as file:
        file.create_group("entry/data")
    with pytest.raises(InputError, match="holds no raw streams"):
        recover(tmp_path / "foreign.h5")
