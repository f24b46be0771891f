"""The simulated drive, moved through simulated time: no threads, no wires."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest

from mocks.devices.axis import Axis
from mocks.devices.cia402 import State
from mocks.devices.clock import DeviceClock
from mocks.devices.dictionary import Dictionary
from mocks.devices.nanotec import RING, RX, TX, NanotecDrive
from mocks.devices.ring import Ring
from mocks.wire.canopen import ObjectError

STEP = 1e-3


class Bench:
    """A drive whose axis follows its demand exactly."""

    def __init__(self, word_order: str = "big", drift: float = 0.0) -> None:
        self.now, self.events = 0.0, list[tuple[str, dict[str, Any]]]()
        self.axis = Axis(0.030, 0.0)
        self.samples: list[Any] = []
        ring = Ring(DeviceClock(0.0, drift), (0.0, 0.0), np.random.default_rng(0), lambda *s: self.samples.append(s))
        objects = Dictionary(word_order)
        self.drive = NanotecDrive(self.axis, ring, objects, lambda kind, **facts: self.events.append((kind, facts)))

    def run(self, seconds: float) -> np.ndarray:
        """Travel at every step."""
        found = []
        for _ in range(round(seconds / STEP)):
            times = self.now + STEP * np.array([0.5, 1.0])
            self.drive.moved(times, self.drive.targets(times)[:, 0])
            self.now = float(times[-1])
            found.append(self.axis.actual)
        return np.array(found)

    def write(self, index: int, value: int, sub: int = 0) -> None:
        size = self.drive.objects.find(index, sub).size
        self.drive.access(index, sub, (value & (1 << 8 * size) - 1).to_bytes(size, "little"), size)

    def enable(self, mode: int) -> None:
        self.write(0x6060, mode)
        for word in (0x06, 0x07, 0x0F):
            self.write(0x6040, word)
        assert self.drive.state is State.ENABLED

    @property
    def status(self) -> int:
        return self.drive.statusword()


def test_the_states_follow_the_controlword() -> None:
    bench = Bench()
    seen = [bench.status & 0x6F]
    for word in (0x06, 0x07, 0x0F, 0x07, 0x06, 0x00):
        bench.write(0x6040, word)
        seen.append(bench.status & 0x6F)
    assert seen == [0x40, 0x21, 0x23, 0x27, 0x23, 0x21, 0x40]


def test_a_disabled_drive_does_not_move() -> None:
    bench = Bench()
    bench.write(0x6060, 1)
    bench.write(0x607A, 60_000)
    bench.write(0x6040, 0x1F)
    assert np.ptp(bench.run(0.2)) == 0.0


def test_a_set_point_is_acknowledged_reached_and_told() -> None:
    bench = Bench()
    bench.enable(1)
    bench.write(0x607A, 60_000)
    bench.write(0x6040, 0x1F)
    assert bench.status & 0x1400 == 0x1000
    travel = bench.run(1.0)
    assert travel[-1] == pytest.approx(0.060)
    assert np.abs(np.diff(travel)).max() <= 0.1 * STEP * 1.001
    assert bench.status & 0x0400
    bench.write(0x6040, 0x0F)
    assert not bench.status & 0x1000


def test_a_relative_set_point_adds_to_the_one_before() -> None:
    bench = Bench()
    bench.enable(1)
    bench.write(0x607A, 10_000)
    for _ in range(2):
        bench.write(0x6040, 0x7F)
        bench.run(0.5)
        bench.write(0x6040, 0x0F)
    assert bench.axis.actual == pytest.approx(0.050)


def test_a_set_point_waits_unless_it_is_to_change_at_once() -> None:
    bench = Bench()
    bench.enable(1)
    bench.write(0x607A, 60_000)
    bench.write(0x6040, 0x1F)
    bench.run(0.1)
    bench.write(0x6040, 0x0F)
    bench.write(0x607A, 40_000)
    bench.write(0x6040, 0x1F)
    assert bench.run(0.6).max() == pytest.approx(0.060)
    bench.write(0x6040, 0x0F)
    bench.write(0x607A, 20_000)
    bench.write(0x6040, 0x3F)
    assert bench.run(1.0)[-1] == pytest.approx(0.020)


def test_a_software_limit_holds_in_position_and_in_velocity_mode() -> None:
    bench = Bench()
    bench.write(0x607D, 70_000, 2)
    bench.enable(1)
    bench.write(0x607A, 90_000)
    bench.write(0x6040, 0x1F)
    assert bench.status & 0x0800
    assert bench.run(2.0).max() == pytest.approx(0.070)
    bench.write(0x6060, 3)
    bench.write(0x60FF, -500_000)
    assert bench.run(2.0).min() == pytest.approx(0.0, abs=1e-9)
    bench.write(0x60FF, 500_000)
    assert bench.run(2.0).max() == pytest.approx(0.070)


def test_a_velocity_is_reached_with_the_given_acceleration() -> None:
    bench = Bench()
    bench.enable(3)
    bench.write(0x6083, 2_000_000)
    bench.write(0x60FF, 100_000)
    travel = bench.run(0.1)
    assert travel[49] - 0.030 == pytest.approx(0.5 * 2.0 * 0.05**2, rel=1e-6)
    assert bench.axis.velocity == pytest.approx(0.1)
    bench.write(0x60FF, 0)
    bench.run(0.2)
    assert bench.axis.velocity == pytest.approx(0.0, abs=1e-9)
    assert bench.status & 0x1400 == 0x1400


@pytest.mark.parametrize(("option", "ends"), [(2, State.DISABLED), (6, State.QUICK_STOP)])
def test_a_quick_stop_brakes_hard_and_stays_stopped(option: int, ends: State) -> None:
    bench = Bench()
    bench.write(0x605A, option)
    bench.enable(3)
    bench.write(0x60FF, 500_000)
    bench.run(0.05)
    speed, before = bench.axis.velocity, bench.axis.actual
    bench.write(0x6040, 0x02)
    bench.run(0.2)
    assert bench.axis.actual - before == pytest.approx(speed**2 / 2 / 12.0, rel=0.05)
    assert bench.drive.state is ends
    assert np.ptp(bench.run(0.1)) == 0.0
    assert "standstill" in [kind for kind, _ in bench.events]


def test_halt_stops_and_keeps_the_drive_enabled() -> None:
    bench = Bench()
    bench.enable(1)
    bench.write(0x607A, 90_000)
    bench.write(0x6040, 0x1F)
    bench.run(0.2)
    bench.write(0x6040, 0x011F)
    bench.run(0.3)
    where = bench.axis.actual
    assert where < 0.080
    assert bench.status & 0x0427 == 0x0427
    bench.write(0x6040, 0x001F)
    assert bench.run(1.0)[-1] == pytest.approx(0.090)


def test_a_jammed_axis_ends_in_a_following_error_until_it_is_reset() -> None:
    bench = Bench()
    bench.enable(3)
    bench.axis.frozen_until = 10.0
    bench.write(0x60FF, 200_000)
    bench.run(0.3)
    assert bench.drive.state is State.FAULT
    assert bench.drive.objects[0x603F] == 0x8611
    assert bench.status & 0x2000
    for word in (0x06, 0x0F):
        bench.write(0x6040, word)
    assert bench.drive.state is State.FAULT
    bench.write(0x6040, 0x80)
    assert bench.drive.state is State.DISABLED
    assert bench.drive.objects[0x603F] == 0


@pytest.mark.parametrize(("method", "edge"), [(17, 0.0), (18, 0.100)])
def test_homing_finds_the_edge_of_the_end_switch(method: int, edge: float) -> None:
    bench = Bench()
    bench.drive.modes.origin = 0.005
    bench.enable(6)
    bench.write(0x6098, method)
    bench.write(0x6040, 0x1F)
    bench.run(3.0)
    assert bench.status & 0x1400 == 0x1400
    counts = int.from_bytes(bench.drive.access(0x6064, 0, None, 4), "little", signed=True)
    assert counts * 1e-6 == pytest.approx(bench.axis.actual - edge, abs=1e-6)


def test_homing_here_makes_this_place_the_home_offset() -> None:
    bench = Bench()
    bench.enable(6)
    bench.write(0x607C, 12_000)
    bench.write(0x6098, 35)
    bench.write(0x6040, 0x1F)
    assert int.from_bytes(bench.drive.access(0x6064, 0, None, 4), "little") == 12_000


def test_the_ring_holds_the_last_60_counted_milliseconds() -> None:
    bench = Bench()
    bench.enable(3)
    bench.write(0x60FF, 100_000)
    travel = bench.run(0.2)
    count, newest, *cells = struct.unpack(">Ii60h", struct.pack(">64H", *(bench.drive.read_block(RING) or [])))
    assert count == 201
    held = np.arange(count - 60, count)
    steps = np.array(cells)[held % 60]
    assert (newest - (steps.sum() - np.cumsum(steps))) * 1e-7 == pytest.approx(travel[held - 1], abs=1e-7)


@pytest.mark.parametrize("drift", [-50e-6, 0.0, 50e-6])
def test_the_ring_counts_on_the_drives_own_clock(drift: float) -> None:
    bench = Bench(drift=drift)
    bench.run(1.0)
    counter = np.concatenate([s[0] for s in bench.samples])
    due = np.concatenate([s[1] for s in bench.samples])
    assert counter.tolist() == list(range(len(counter)))
    assert due == pytest.approx(counter * 1e-3 / (1.0 + drift), abs=1e-12)


def test_the_image_is_packed_as_the_manual_says_and_can_be_mapped_anew() -> None:
    bench = Bench()
    image = bench.drive.read_block(TX) or []
    assert image[0] == bench.status
    assert image[2] << 16 | image[3] == 30_000
    bench.write(0x3602, 0)
    for sub, entry in enumerate((0x60640020, 0x60410010), start=1):
        bench.write(0x3602, entry, sub)
    bench.write(0x3602, 2)
    image = bench.drive.read_block(TX) or []
    assert (image[0] << 16 | image[1], image[2]) == (30_000, bench.status)


def test_the_word_order_turns_32_bit_values_round_in_image_and_ring() -> None:
    big, little = Bench(), Bench("little")
    for bench in (big, little):
        bench.run(0.05)
    image, turned = (bench.drive.read_block(TX) or [] for bench in (big, little))
    assert image[2:4] == turned[2:4][::-1]
    assert image[0] == turned[0]
    ring, turned = (bench.drive.read_block(RING) or [] for bench in (big, little))
    assert np.array_equal(np.array(ring).reshape(-1, 2), np.array(turned).reshape(-1, 2)[:, ::-1])


def test_an_image_written_takes_effect_as_a_whole() -> None:
    bench = Bench()
    for word in (0x06, 0x07):
        bench.drive.write_block(RX, 0, [word])
    target = [0, 50_000]
    speeds = [*divmod(200_000, 65536), *divmod(2_000_000, 65536), *divmod(2_000_000, 65536)]
    bench.drive.write_block(RX, 0, [0x0F, 1, *target, *speeds])
    bench.drive.write_block(RX, 0, [0x1F, 1, *target, *speeds])
    assert bench.run(1.0)[-1] == pytest.approx(0.050)


def test_what_the_drive_has_not_is_refused() -> None:
    bench = Bench()
    with pytest.raises(ObjectError, match="no object 1234"):
        bench.drive.access(0x1234, 0, None, 2)
    with pytest.raises(ObjectError, match="read only"):
        bench.drive.access(0x6041, 0, b"\0\0", 2)
    with pytest.raises(ObjectError, match="bytes"):
        bench.drive.access(0x6040, 0, b"\0", 1)
