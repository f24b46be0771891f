"""The simulated instruments' bytes against the protocol table's own examples."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from mocks.wire import gsv8, hlg1
from mocks.wire.line import Adapter, Line


def amplifier(**changed: object) -> gsv8.Amplifier:
    calls = {"value": lambda: 12.5, "zero": lambda: None, "start": lambda on: None, "rate": lambda rate: rate or 2000.0}
    return gsv8.Amplifier(**(calls | changed))  # type: ignore[arg-type]


def test_a_force_leaves_as_one_float_frame() -> None:
    frames = gsv8.frames(np.array([15.1875]), np.array([False]))
    assert frames.tobytes() == bytes.fromhex("aa10b0") + struct.pack(">f", 15.1875) + b"\x85"


def test_an_overload_shows_in_the_status_of_its_frame_alone() -> None:
    frames = gsv8.frames(np.array([1.0, 2.0]), np.array([False, True]))
    assert frames[:, 2].tolist() == [0xB0, 0xB1]


@pytest.mark.parametrize(
    ("request_", "answer"),
    [
        ("aa902385", "aa500085"),
        ("aa948b44fa000085", "aa500085"),
        ("aa908a85", "aa540044fa000085"),
        ("aa902485", "aa500085"),
        ("aa90ee85", "aa504085"),
        ("aa903b85", "aa10b04148000085"),
    ],
)
def test_the_amplifier_answers_the_vendor_librarys_bytes(request_: str, answer: str) -> None:
    (found,) = gsv8.Requests().feed(bytes.fromhex(request_))
    assert amplifier().reply(*found).hex() == answer


def test_a_command_is_found_among_junk_and_over_pieces() -> None:
    requests = gsv8.Requests()
    assert requests.feed(b"\x00\x85\xaa\xaa\x90") == []
    assert requests.feed(b"\x23\x85\xaa\x91\x0c\x00\x85") == [(0x23, b""), (0x0C, b"\0")]


def test_a_refused_parameter_is_answered_with_an_error() -> None:
    def refuse(rate: float | None) -> float:
        raise ValueError

    assert amplifier(rate=refuse).reply(0x8B, struct.pack(">f", 1e6)) == gsv8.answer(gsv8.PARAMETER)


def test_a_position_leaves_as_fifteen_characters_in_tenths_of_a_micrometre() -> None:
    counts = hlg1.counts(np.array([2.5e-3, -12.3456e-3]), np.array([False, False]))
    assert hlg1.frames(counts).tobytes() == b"%01$+0025000**\r%01$-0123456**\r"


def test_what_the_gauge_cannot_see_is_sent_as_the_alarm_value() -> None:
    counts = hlg1.counts(np.array([0.96, 0.0]), np.array([False, True]))
    assert hlg1.frames(counts).tobytes() == b"%01$+9500000**\r" * 2


def test_the_sensor_answers_with_and_without_a_block_check() -> None:
    sensor = hlg1.Sensor(lambda: -25_000, lambda on: None, lambda rate: rate or 2000.0)
    plain, checked = b"%01#RMD**", b"%01#RMD" + hlg1.bcc(b"%01#RMD")
    assert sensor.reply(plain) == sensor.reply(checked) == b"%01$RMD-0025000**\r"
    assert sensor.reply(b"%01#RMD00") == b"%01!01**\r"
    assert sensor.reply(b"%02#RMD**") == b""
    assert sensor.reply(b"%01#RSP**") == b"%01$RSP+00001**\r"


def test_frames_leave_one_after_another_at_the_baud_rate() -> None:
    line = Line(10.0 / 230_400)
    frames = np.arange(32, dtype=np.uint8).reshape(4, 8)
    ends = line.put_frames(frames, np.array([0.0, 1e-4, 2e-4, 1.0]))
    length = 80.0 / 230_400
    assert ends == pytest.approx([length, 2 * length, 3 * length, 1.0 + length])
    assert line.take(ends[1] - 1e-9) == bytes(range(15))
    assert line.take(2.0) == bytes(range(15, 32))


def test_an_answer_waits_for_the_frame_under_way() -> None:
    line = Line(1e-4)
    line.put_frames(np.full((1, 8), 1, np.uint8), np.array([0.0]))
    line.put(b"ab", 1e-4)
    assert line.take(8e-4 + 1e-9) == b"\1" * 8
    assert line.take(10e-4 + 1e-9) == b"ab"


def test_an_adapters_timer_ticks_at_its_own_period() -> None:
    adapter = Adapter(np.random.default_rng(0), timer=0.016, phase=1.0)
    assert adapter.tick_after(1.0) == pytest.approx(1.016)
    assert adapter.tick_after(1.0159) == pytest.approx(1.016)
    assert adapter.tick_after(0.9) == pytest.approx(0.904)
