"""Samples come out of a byte stream alike, however it was cut into reads and whatever junk it holds."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stand.codecs.codec import Feeder, load_codec, names
from stand.errors import InputError
from tests.stand.wires import frames_of

GAUGES = {"gsv-8": "force_gauge", "hl-g1": "dial_gauge"}
VALUES = np.array([0.0, -0.0125, 0.08271, -0.9499, 0.5, 1e-7] * 4)
codecs = pytest.mark.parametrize("name", sorted(GAUGES))


def _fed(name: str, parts: list[bytes]) -> tuple[list[float], Feeder]:
    feeder = Feeder(load_codec(name), "gauge")
    values = [v for part in parts for v in feeder.feed(part, 0.0).values.tolist()]
    return values, feeder


def _cut(data: bytes, cuts: list[int]) -> list[bytes]:
    edges = [0, *sorted(c % (len(data) + 1) for c in cuts), len(data)]
    return [data[a:b] for a, b in itertools.pairwise(edges)]


@codecs
@given(cuts=st.lists(st.integers(0, 10_000), max_size=40))
@settings(max_examples=60, deadline=None)
def test_any_cut_of_the_bytes_gives_the_same_samples(name: str, cuts: list[int]) -> None:
    data = frames_of(GAUGES[name], VALUES).tobytes()
    values, feeder = _fed(name, _cut(data, cuts))
    np.testing.assert_allclose(values, VALUES, atol=5e-8, rtol=1e-6)
    assert feeder.junk == 0


@codecs
@given(junk=st.binary(max_size=40).map(lambda b: bytes(c for c in b if c not in b"\xaa%")), place=st.integers(0, 24))
@settings(max_examples=60, deadline=None)
def test_junk_between_frames_is_skipped_and_counted(name: str, junk: bytes, place: int) -> None:
    frames = [row.tobytes() for row in frames_of(GAUGES[name], VALUES)]
    values, feeder = _fed(name, [b"".join(frames[:place]) + junk + b"".join(frames[place:])])
    np.testing.assert_allclose(values, VALUES, atol=5e-8, rtol=1e-6)
    assert feeder.junk == len(junk) if place < len(frames) else feeder.junk <= len(junk)


@codecs
@given(noise=st.binary(max_size=200), cuts=st.lists(st.integers(0, 500), max_size=10))
@settings(max_examples=60, deadline=None)
def test_arbitrary_bytes_never_break_it_and_cuts_do_not_matter(name: str, noise: bytes, cuts: list[int]) -> None:
    data = frames_of(GAUGES[name], VALUES[:5]).tobytes()
    stream = data[:17] + noise + data
    whole, one = _fed(name, [stream])
    parts, many = _fed(name, _cut(stream, cuts))
    np.testing.assert_array_equal(parts, whole)
    assert many.junk == one.junk


@codecs
def test_a_damaged_byte_costs_one_frame_and_counts_as_junk(name: str) -> None:
    frames = frames_of(GAUGES[name], VALUES).copy()
    frames[7, 0] ^= 0xFF
    values, feeder = _fed(name, [frames.tobytes()])
    assert len(values) == len(VALUES) - 1
    assert feeder.junk == frames.shape[1]


def test_an_overload_and_an_alarm_are_flagged() -> None:
    overload = Feeder(load_codec("gsv-8"), "force_gauge").feed(bytes.fromhex("aa10b141200000 85".replace(" ", "")), 1.0)
    assert overload.values.tolist() == [10.0]
    assert overload.flags.tolist() == [1]
    alarm = Feeder(load_codec("hl-g1"), "dial_gauge").feed(b"%01$+9500000**\r", 1.0)
    assert alarm.flags.tolist() == [1]


def test_the_published_hl_g1_example_reads_two_and_a_half_millimetres() -> None:
    block = Feeder(load_codec("hl-g1"), "dial_gauge").feed(b"%01$+0025000**\r", 1.0)
    assert block.values.tolist() == pytest.approx([2.5e-3])


def test_a_wrong_check_character_makes_a_frame_junk_and_a_right_one_passes() -> None:
    body = b"%01$-0000010"
    code = 0
    for byte in body:
        code ^= byte
    right = Feeder(load_codec("hl-g1"), "g").feed(body + b"%02X\r" % code, 0.0)
    wrong = Feeder(load_codec("hl-g1"), "g").feed(body + b"%02X\r" % (code ^ 1), 0.0)
    assert right.values.tolist() == pytest.approx([-1e-6])
    assert len(wrong) == 0


def test_an_answer_amid_the_stream_is_no_junk() -> None:
    data = frames_of("force_gauge", VALUES[:4]).tobytes()
    feeder = Feeder(load_codec("gsv-8"), "force_gauge")
    block = feeder.feed(data[:16] + bytes.fromhex("aa500085") + data[16:], 0.0)
    assert len(block) == 4
    assert feeder.junk == 0
    assert feeder.replies == [bytes.fromhex("aa500085")]


def test_the_commands_are_the_bytes_that_the_vendors_library_sends() -> None:
    codec = load_codec("gsv-8")
    assert codec.stop == bytes.fromhex("aa902385")
    assert codec.start == bytes.fromhex("aa902485")
    assert codec.rate(2000.0) == bytes.fromhex("aa948b44fa000085")


def test_each_codec_in_the_folder_states_its_source_and_an_unknown_one_lists_them() -> None:
    assert set(GAUGES) <= set(names())
    assert all(load_codec(name).source for name in names())
    with pytest.raises(InputError, match=r"gsv-8.*hl-g1"):
        load_codec("abacus")
