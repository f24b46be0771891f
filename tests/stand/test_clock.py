"""Three instruments on clocks of their own land on one time base; what got lost is found, placed and marked."""

from __future__ import annotations

import numpy as np
import pytest

from stand.block import Block
from stand.clock import GaugeStream, LiveAligner, LiveBlock, RingStream, align
from stand.clock.lines import line_below, line_between
from stand.clock.polls import pack_poll
from stand.clock.resample import fill, interpolate, smooth
from stand.codecs.codec import Feeder, load_codec
from stand.drive.profile import load_profile
from stand.errors import InputError
from stand.excitation.spec import Shape
from stand.transport.raw import RawRegisters
from stand.transport.ring import RingDecoder
from tests.stand.alignment import judge, time_error
from tests.stand.wires import Wires, draw


@pytest.mark.parametrize(("seed", "shape"), [(0, Shape.RECTANGULAR), (1, Shape.TRAPEZOIDAL)])
def test_bunched_arrivals_on_drifting_clocks_are_placed_within_the_promised_time(seed: int, shape: Shape) -> None:
    outcome = judge(draw(seed, shape, wrong_by_sigma=1.0))
    assert outcome.force_gauge < 100e-6
    assert outcome.dial_gauge < 100e-6
    assert outcome.drive < 20e-6
    assert outcome.x_rms < 5e-6
    assert outcome.x_rms < 2 * outcome.x_stated
    assert outcome.missing == 0


@pytest.mark.slow
@pytest.mark.parametrize("shape", [Shape.TRAPEZOIDAL, Shape.RECTANGULAR, Shape.QUASI_SINUSOIDAL])
@pytest.mark.parametrize("timer", [0.016, None])
def test_the_worst_of_fifty_seeds_keeps_the_promise(shape: Shape, timer: float | None) -> None:
    for seed in range(50):
        outcome = judge(draw(seed, shape, timer=timer, wrong_by_sigma=1.0 if seed % 2 else -1.0))
        assert max(outcome.force_gauge, outcome.dial_gauge) < 100e-6, seed
        assert outcome.drive < 20e-6, seed
        assert outcome.x_rms < 5e-6, seed


@pytest.mark.parametrize("seed", [20, 25, 35])
def test_a_timer_in_step_with_the_frames_leaves_their_phase_open_and_the_stated_error_says_so(seed: int) -> None:
    wires = draw(seed, off=0.0)
    aligned = align(wires.streams, wires.stand, wires.origin, wires.count)
    for name in ("force_gauge", "dial_gauge"):
        error, stated = time_error(wires, aligned, name), aligned.clocks[name].sigma
        assert error < 260e-6
        assert error < 3 * stated


@pytest.mark.parametrize("timer", [0.016, None])
def test_lost_frames_are_counted_placed_within_fifty_milliseconds_and_marked(timer: float | None) -> None:
    lost = {"force_gauge": ((9000, 1),), "dial_gauge": ((5000, 3),)}
    wires = draw(2, timer=timer, lost=lost)
    aligned = align(wires.streams, wires.stand, wires.origin, wires.count)
    found = {loss.instrument: loss for loss in aligned.losses}
    assert {name: loss.count for name, loss in found.items()} == {"force_gauge": 1, "dial_gauge": 3}
    for name, ((first, _),) in lost.items():
        assert found[name].time == pytest.approx(wires.epochs[name] + first * wires.periods[name], abs=0.05)
        assert time_error(wires, aligned, name) < 100e-6
    marked = np.flatnonzero(aligned.quality & 4)
    assert 1 <= len(marked) <= 3
    assert np.all(np.abs(aligned.origin + marked / 2000 - found["force_gauge"].time) < 0.002)


def _delayed(wires: Wires, seed: int, held: bool) -> dict[str, GaugeStream | RingStream]:
    """As a busy host gets them: all reads of a quarter of a second at once, or stretches late by some milliseconds."""
    rng, found = np.random.default_rng(seed), dict(wires.streams)
    for name, stream in wires.streams.items():
        if not isinstance(stream, GaugeStream):
            continue
        time = stream.arrival_time - stream.arrival_time[0]
        late = time.copy()
        for begin, end in ((2.0, 2.6), (3.0, 3.9), (8.0, 9.2)):
            inside = (time >= begin) & (time < end)
            parts = begin + 0.25 * np.ceil((time[inside] - begin) / 0.25)
            slow = time[inside] + rng.uniform(0.3e-3, 1e-3) + rng.exponential(5e-4, np.count_nonzero(inside))
            late[inside] = parts if held else slow
        late = np.maximum.accumulate(late)
        last = np.append(np.diff(late) > 0, True)
        sizes = np.diff(np.cumsum(stream.arrival_bytes)[last], prepend=0)
        found[name] = GaugeStream(stream.raw, late[last] + stream.arrival_time[0], sizes)
    return found


@pytest.mark.parametrize(
    ("seed", "held", "timer"),
    [
        (1, True, 0.016),
        (1, True, None),
        (1, False, 0.016),
        pytest.param(1, False, None, marks=pytest.mark.slow),  # every late stretch is searched for a loss
        *[pytest.param(2, held, timer, marks=pytest.mark.slow) for held in (True, False) for timer in (0.016, None)],
    ],
)
def test_a_busy_host_loses_no_frame_that_came_and_hides_none_that_did_not(
    seed: int, held: bool, timer: float | None
) -> None:
    wires = draw(seed, timer=timer)
    aligned = align(_delayed(wires, seed, held), wires.stand, wires.origin, wires.count)
    assert aligned.losses == ()
    assert max(time_error(wires, aligned, name) for name in ("force_gauge", "dial_gauge")) < 100e-6
    lost = {"force_gauge": ((11_500, 1),), "dial_gauge": ((12_300, 3),)}
    wires = draw(seed, timer=timer, lost=lost)
    aligned = align(_delayed(wires, seed, held), wires.stand, wires.origin, wires.count)
    found = {loss.instrument: loss for loss in aligned.losses}
    assert {loss.instrument: loss.count for loss in aligned.losses} == {"force_gauge": 1, "dial_gauge": 3}
    for name, ((first, _),) in lost.items():
        assert found[name].time == pytest.approx(wires.epochs[name] + first * wires.periods[name], abs=0.05)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_where_one_leg_of_the_polls_grows_for_seconds_the_stated_error_of_x_covers_it(seed: int) -> None:
    wires, rng = draw(seed), np.random.default_rng(seed)
    ring = wires.streams["drive"]
    assert isinstance(ring, RingStream)
    time, late = ring.request_time - wires.origin, rng.exponential(3e-4, len(ring.request_time)) + 1e-4
    asked = ring.request_time - late * ((time > 1.5) & (time < 4.0))
    answered = ring.response_time + late * (time > 6.5)
    busy = RingStream(ring.registers, asked, answered)
    aligned = align({**wires.streams, "drive": busy}, wires.stand, wires.origin, wires.count)
    assert time_error(wires, aligned, "drive") < 3 * aligned.clocks["drive"].sigma
    x = wires.truth["drive"] - float(np.median(wires.truth["drive"][:800]))
    rms = np.sqrt(np.mean((aligned.channels["drive_position"] - x) ** 2))
    assert rms < 2 * aligned.uncertainty["drive_position"]


def test_the_same_bytes_and_times_give_the_same_grid_bit_for_bit() -> None:
    wires = draw(3)
    first, second = (align(wires.streams, wires.stand, wires.origin, wires.count) for _ in range(2))
    for name, values in first.channels.items():
        np.testing.assert_array_equal(values, second.channels[name])


def test_plain_polling_is_labelled_derived_and_within_what_its_brackets_say() -> None:
    wires = draw(1)
    drive = wires.stand.drive.model_copy(update={"profile": "mr-je-c"})
    time = wires.origin + np.arange(-5, 1010) * 0.01
    x = np.interp(time - wires.origin, np.arange(wires.count) / 2000, wires.truth["drive"])
    v = np.interp(time - wires.origin, np.arange(wires.count) / 2000, np.gradient(wires.truth["drive"], 5e-4))
    polls = np.array([pack_poll(round(a * 1e6), round(b * 1e6)) for a, b in zip(x, v, strict=True)])
    stream = RingStream(polls, time - 1e-4, time + 1e-4)
    stand = wires.stand.model_copy(update={"drive": drive})
    aligned = align({"drive": stream}, stand, wires.origin, wires.count)
    assert aligned.derived == {"drive_position"}
    error = aligned.channels["drive_position"] - (wires.truth["drive"] - wires.truth["drive"][0])
    assert np.sqrt(np.mean(error**2)) < 2 * aligned.uncertainty["drive_position"]


def test_a_stream_too_short_for_a_clock_is_refused() -> None:
    wires = draw(1)
    short = {"force_gauge": GaugeStream(np.empty(0, np.uint8), np.empty(0), np.empty(0, np.int64))}
    with pytest.raises(InputError, match=r"force_gauge.*too short"):
        align(short, wires.stand, wires.origin, wires.count)


def _blocks(wires: Wires) -> list[Block]:
    """What readers would have handed on, in order of arrival."""
    blocks: list[Block] = []
    for name in ("force_gauge", "dial_gauge"):
        stream = wires.streams[name]
        assert isinstance(stream, GaugeStream)
        feeder = Feeder(load_codec(wires.stand.instruments[name].codec), name)  # type: ignore[union-attr]
        edges = np.concatenate(([0], np.cumsum(stream.arrival_bytes)))
        for k, arrival in enumerate(stream.arrival_time.tolist()):
            blocks.append(feeder.feed(stream.raw[edges[k] : edges[k + 1]].tobytes(), arrival))
    ring, decoder = wires.streams["drive"], RingDecoder(load_profile(wires.stand.drive.profile))
    assert not isinstance(ring, GaugeStream)
    for registers, request, response in zip(ring.registers, ring.request_time, ring.response_time, strict=True):
        block = decoder.decode(RawRegisters("drive", registers, float(request), float(response)))
        if block is not None:
            blocks.append(block)
    return sorted(blocks, key=lambda b: b.arrival)


def test_the_live_grid_has_every_sample_once_and_agrees_with_the_file_to_a_millisecond() -> None:
    wires = draw(4)
    live = LiveAligner(wires.stand, wires.origin)
    parts: list[LiveBlock] = [b for b in map(live.push, _blocks(wires)) if b is not None]
    index = np.concatenate([np.arange(p.first, p.first + len(p.time)) for p in parts])
    np.testing.assert_array_equal(index, np.arange(len(index)))
    assert len(index) >= wires.count - 100
    n = min(len(index), wires.count)
    x = np.concatenate([p.x for p in parts])[:n]
    speed = np.gradient(wires.truth["drive"][:n], 5e-4)
    true = wires.truth["drive"][:n] - wires.truth["drive"][0]
    assert np.all(np.abs(x - true) < 1e-3 * np.abs(speed).max() + 5e-6)


def test_the_line_below_points_ignores_how_late_the_late_ones_are() -> None:
    rng = np.random.default_rng(0)
    k = np.arange(2000.0)
    late = rng.exponential(2e-3, 2000)
    line = line_below(k, 5.0 + 5e-4 * k + late, 5e-4)
    assert line.at(0.0) == pytest.approx(5.0, abs=2e-5)
    assert line.slope == pytest.approx(5e-4, rel=1e-4)


def test_the_line_between_points_keeps_away_from_both_and_says_when_none_fits() -> None:
    k = np.arange(100.0)
    line = line_between(k, 2.0 * k - 1, k, 2.0 * k + 3, 2.0)
    assert line.margin == pytest.approx(2.0)
    assert line.at(50.0) == pytest.approx(101.0)
    assert line_between(k, 2.0 * k + 1, k, 2.0 * k, 2.0).margin == pytest.approx(-0.5)


def test_interpolation_adds_no_bias_below_three_quarters_of_nyquist() -> None:
    n = np.arange(2000)
    for share in (0.05, 0.3, 0.6):
        wave = np.sin(np.pi * share * n + 1)
        place = np.linspace(50, 1950, 777)
        np.testing.assert_allclose(interpolate(wave, place), np.sin(np.pi * share * place + 1), atol=2e-3)


def test_a_gap_is_bridged_smoothly_and_known_as_such() -> None:
    index = np.array([0, 1, 2, 6, 7, 8])
    even, there = fill(index, index.astype(float) ** 2, np.ones(6, dtype=np.bool_))
    np.testing.assert_allclose(even, np.arange(9.0) ** 2, atol=1.0)
    assert there.tolist() == [True, True, True, False, False, False, True, True, True]


def test_smoothing_lowers_the_noise_states_what_is_left_and_keeps_the_motion() -> None:
    rng = np.random.default_rng(5)
    t = np.arange(8000) / 1000
    true = 0.01 * np.sin(2 * np.pi * 2 * t)
    smoothed, sigma = smooth(true + rng.normal(0, 1e-6, len(t)), 1e-3)
    error = (smoothed - true)[200:-200].std()
    assert error < 0.6e-6
    assert sigma == pytest.approx(error, rel=0.3)
