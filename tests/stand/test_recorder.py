"""The live recorder: nothing dropped, every object there before the first sample, a killed writer leaves a file."""

from __future__ import annotations

import itertools
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pytest

from stand.block import Block
from stand.clock.model import LiveBlock
from stand.codecs.codec import Feeder, load_codec
from stand.errors import StandError
from stand.excitation.spec import Excitation, Shape
from stand.recorder import FilePlan, Happening, Recorder, StreamSpec, Taken, Wire
from stand.recording import read_recording
from stand.setup import Setup
from stand.transport.raw import RawBytes, RawRegisters

SPECS = (
    StreamSpec("force_gauge", Wire.BYTES, "N", 2000.0, "stream", bytes_per_sample=8,
               texts={"identity": {"serial": "4711"}}, numbers={"calibration": {"latency": (0.001, "s")}}),
    StreamSpec("drive", Wire.REGISTERS, "m", 1000.0, "ring", width=4, reads_per_second=100),
)  # fmt: skip
EXCITATION = Excitation(Shape.TRAPEZOIDAL, 1.0, 0.02, 0.1, 2)


def plan(seconds: float = 2.0) -> FilePlan:
    return FilePlan(SPECS, Setup(), EXCITATION, 'name = "x"', seconds=seconds)


def grid(first: int, n: int, value: float) -> LiveBlock:
    values = np.full(n, value)
    return LiveBlock(first, (first + np.arange(n)) / 2000, values, values, values, np.zeros(n, np.uint8), value)


def feed(recorder: Recorder, n: int, now: float) -> None:
    block = Block("force_gauge", 10 * n, np.arange(10.0), None, np.zeros(10, np.uint8), now)
    recorder.put(Taken(RawBytes("force_gauge", bytes(range(80)), now), block))
    ring = Block("drive", 5 * n, np.arange(5.0), np.arange(5) + 5 * n, np.zeros(5, np.uint8), now)
    recorder.put(Taken(RawRegisters("drive", np.arange(4, dtype=np.uint16) + n, now - 0.001, now), ring))
    recorder.put(grid(10 * n, 10, now))


def test_everything_that_was_put_in_comes_out(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "run.h5", plan())
    recorder.start()
    for n in range(500):
        feed(recorder, n, float(n))
    recorder.put(Happening(3.5, "mark", "Gewicht berührt"))
    recorder.close()
    with h5py.File(tmp_path / "run.h5") as file:
        force, drive = file["entry/instruments/force_gauge"], file["entry/instruments/drive"]
        assert force["raw"][()].tobytes() == bytes(range(80)) * 500
        assert force["arrival_time"][()].tolist() == list(range(500))
        assert force["arrival_bytes"][()].sum() == 80 * 500
        assert force["frames_counted"][()] == 5000
        assert force["identity/serial"][()] == b"4711"
        assert drive["registers"].shape == (500, 4)
        assert drive["ticks"][()].tolist() == list(range(2500))
        assert file["entry/events/text"][0].decode() == "Gewicht berührt"
        assert not file["entry/events"].attrs["complete"]
    assert len(read_recording(tmp_path / "run.h5").time) == 5000


def test_what_is_counted_is_what_the_raw_bytes_hold_wherever_the_recording_begins(tmp_path: Path) -> None:
    codec = load_codec("gsv-8")
    stream = b"".join(b"\xaa\x10\xb0" + struct.pack(">f", value) + b"\x85" for value in range(40))
    for begin, size in itertools.product(range(1, 12), (3, 8, 20)):
        recorder, feeder = Recorder(tmp_path / f"{begin}-{size}.h5", plan()), Feeder(codec, "force_gauge")
        recorder.start()
        feeder.feed(stream[:begin], 0.0)  # read before the recording began
        for at in range(begin, len(stream), size):
            data = stream[at : at + size]
            block = feeder.feed(data, float(at))
            recorder.put(Taken(RawBytes("force_gauge", data, float(at)), block if len(block) else None))
        recorder.close()
        with h5py.File(recorder.path) as file:
            force = file["entry/instruments/force_gauge"]
            held = codec.scan(force["raw"][()]).values
            assert force["values"][()].tolist() == held.tolist()
            assert force["frames_counted"][()] == len(held) == 40 - -(-begin // 8)


def test_a_run_longer_than_its_reserve_is_kept_whole(tmp_path: Path) -> None:
    small = FilePlan(SPECS, Setup(), EXCITATION, seconds=-16.0)  # no reserve to speak of
    recorder = Recorder(tmp_path / "run.h5", small)
    recorder.start()
    for n in range(3000):
        feed(recorder, n, float(n))
    recorder.close()
    assert len(read_recording(tmp_path / "run.h5").time) == 30000


def test_a_long_run_s_first_samples_do_not_wait_until_room_for_all_is_filled(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "run.h5", plan(seconds=3600.0))
    recorder.start()
    feed(recorder, 0, 0.0)
    recorder.close()
    about = (tmp_path / "run.h5").stat()
    assert about.st_size > 50e6  # room for the hour
    assert about.st_blocks * 512 < 1e6  # of which next to nothing has been written


def test_an_existing_file_is_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "run.h5").write_bytes(b"precious")
    with pytest.raises(StandError, match="recording failed"):
        Recorder(tmp_path / "run.h5", plan()).start()
    assert (tmp_path / "run.h5").read_bytes() == b"precious"


FEEDER = """
import sys, time
from pathlib import Path
from stand.recorder import Recorder
from tests.stand.test_recorder import feed, plan
recorder = Recorder(Path(sys.argv[1]), plan(), flush=float(sys.argv[2]))
recorder.start()
n = 0
while True:
    feed(recorder, n, time.monotonic())
    n += 1
    if n == 40:
        print("going", flush=True)
    time.sleep(0.005)
"""


@pytest.mark.parametrize(("flush", "after"), [(0.2, 0.05), (0.2, 0.33), (0.002, 0.1), (0.002, 0.17)])
def test_a_killed_recorder_leaves_a_file_with_all_but_the_last_moment(
    tmp_path: Path, flush: float, after: float
) -> None:
    path = tmp_path / "run.h5"
    child = subprocess.Popen([sys.executable, "-c", FEEDER, str(path), str(flush)], stdout=subprocess.PIPE)
    assert child.stdout is not None
    child.stdout.readline()
    time.sleep(after)  # the moment of the kill is what varies here
    killed = time.monotonic()
    child.send_signal(signal.SIGKILL)
    child.wait()
    child.stdout.close()
    recording = read_recording(path)
    assert recording.complete is False
    assert killed - recording.x[-1] < 0.6
    with h5py.File(path) as file:
        assert killed - file["entry/instruments/force_gauge/arrival_time"][-1] < 0.6
