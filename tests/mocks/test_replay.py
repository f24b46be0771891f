"""A recording played through simulated devices: the same bytes, the same samples."""

from __future__ import annotations

import struct
import time
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from pymodbus.client import ModbusTcpClient

from mocks.devices.playback import PlayClock, RecordedRing
from mocks.devices.ring import DEPTH
from tests.mocks.serving import opened, process

SECONDS, SAMPLE_0 = 1.5, 1234.5


def ring_registers(heads: np.ndarray, values: np.ndarray, order: str) -> np.ndarray:
    """Reads [polls, 64] of a ring that holds values[k] as sample k."""
    reads = []
    for head in heads.tolist():
        cells = [0] * DEPTH
        for k in range(head - DEPTH, head):
            cells[k % DEPTH] = int(values[k] - values[k - 1])
        reads.append(np.frombuffer(struct.pack(f">Ii{DEPTH}h", head, values[head - 1], *cells), ">u2"))
    pairs = np.array(reads, np.uint16).reshape(len(heads), -1, 2)
    return (pairs if order == "big" else pairs[..., ::-1]).reshape(len(heads), -1)


def recorded_ring(order: str = "big") -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """values int32 by sample, registers and the polls' times: sample k was taken at SAMPLE_0 + k ms."""
    rng = np.random.default_rng(4)
    values = (300_000 + np.cumsum(rng.integers(-900, 900, 5000))).astype(np.int32)
    polls = SAMPLE_0 + 0.1 + np.cumsum(rng.uniform(0.005, 0.012, int(SECONDS * 110)))
    polls = polls[polls < SAMPLE_0 + 0.1 + SECONDS]
    heads = np.floor((polls - SAMPLE_0) * 1000.0).astype(np.int64) + 1
    return values, ring_registers(heads, values, order), polls


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """A file with raw streams of 1.5 s."""
    rng, path = np.random.default_rng(2), tmp_path / "run.h5"
    values, registers, polls = recorded_ring()
    with h5py.File(path, "w") as file:
        for name, size in (("force_gauge", 8), ("dial_gauge", 15)):
            group = file.create_group(f"entry/instruments/{name}")
            sizes = rng.integers(0, 10 * size, round(SECONDS * 400))
            group["raw"] = rng.integers(0, 256, sizes.sum(), dtype=np.uint8)
            group["arrival_time"] = SAMPLE_0 + 0.1 + np.arange(len(sizes)) / 400.0
            group["arrival_bytes"] = sizes.astype(np.int32)
        group = file.create_group("entry/instruments/drive")
        group["registers"], group["request_time"], group["response_time"] = registers, polls - 2e-4, polls + 2e-4
        group["expected"] = values
    return path


def ring_samples(found: dict[int, int], registers: list[int]) -> int:
    """Adds the samples of one read; returns its count."""
    count, value, *cells = struct.unpack(f">Ii{DEPTH}h", struct.pack(">64H", *registers))
    for k in range(count - 1, count - DEPTH - 1, -1):
        found[k] = value
        value -= cells[k % DEPTH]
    return int(count)


@pytest.mark.parametrize("speed", ["1", "max"])
def test_every_byte_and_every_ring_sample_comes_again(recording: Path, speed: str) -> None:
    with h5py.File(recording) as file:
        raw = {n: file[f"entry/instruments/{n}/raw"][()].tobytes() for n in ("force_gauge", "dial_gauge")}
        expected = file["entry/instruments/drive/expected"][()]
        reads = file["entry/instruments/drive/registers"][()]
    last = int(reads[-1, 0]) << 16 | int(reads[-1, 1])
    with process("replay", recording, "--speed", speed) as stand:
        host, _, number = stand["drive"]["tcp"].rpartition(":")
        client = ModbusTcpClient(host, port=int(number), retries=0)
        assert client.connect()
        found: dict[int, int] = {}
        with opened(stand["force_gauge"]["port"]) as force, opened(stand["dial_gauge"]["port"]) as dial:
            started = time.monotonic()
            while ring_samples(found, client.read_holding_registers(2000, count=64).registers) < last:
                assert time.monotonic() < started + 30.0
                for port, name in ((force, "force_gauge"), (dial, "dial_gauge")):
                    port.read_what_is_there()
                    assert raw[name].startswith(bytes(port.data))
            took = time.monotonic() - started
            assert force.read_bytes(len(raw["force_gauge"])) == raw["force_gauge"]
            assert dial.read_bytes(len(raw["dial_gauge"])) == raw["dial_gauge"]
        client.close()
    assert took > SECONDS if speed == "1" else took < 5.0
    assert all(expected[k] == value for k, value in found.items())
    assert set(range(min(found), last)) <= set(found)


@pytest.mark.parametrize("order", ["big", "little"])
def test_the_ring_counts_as_it_did_at_the_recorded_time(order: str) -> None:
    _, registers, polls = recorded_ring(order)
    clock = PlayClock(1.0, SAMPLE_0)
    clock.begin(0.0)
    ring = RecordedRing(registers, polls - 2e-4, polls + 2e-4, clock)
    assert ring.word_order == order
    assert ring.start == pytest.approx(SAMPLE_0, abs=2e-4)
    for k in range(110, 1500, 20):
        assert ring.count(clock.true(SAMPLE_0 + k * 1e-3 + 0.5e-3)) == pytest.approx(k + 1, abs=1)


def test_a_slow_reader_misses_no_sample() -> None:
    _, registers, polls = recorded_ring()
    clock = PlayClock(0.0, SAMPLE_0)
    clock.begin(0.0)
    ring = RecordedRing(registers, polls, polls, clock)
    counts = [ring.count(10.0) for _ in range(60)]
    assert max(np.diff(counts)) == DEPTH
    assert counts[-1] == ring.last


def test_a_file_without_raw_streams_is_refused_by_name(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "run.h5", "w") as file:
        file.create_group("entry/data")
    with pytest.raises(AssertionError, match="/entry/instruments/drive: holds no registers, request_time"):
        refused(tmp_path / "run.h5")


def refused(path: Path) -> Any:
    with process("replay", path) as announcement:
        return announcement
