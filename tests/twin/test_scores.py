"""Scores as `verdict.md` defines them, at once and as the samples come in."""

from __future__ import annotations

import math

import numpy as np
import pytest

from twin.score import best_lag, pearson, psi, score
from twin.score.stream import SlidingR, StreamR

TIME = np.arange(20_000) / 2000.0


def pair(seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    measured = 3.0 + np.sin(7 * TIME) + 0.3 * np.sin(40 * TIME)
    return measured, measured + 0.1 * rng.standard_normal(len(TIME))


def test_R_is_blind_to_gain_and_offset_and_psi_is_the_papers() -> None:
    a, _ = pair()
    assert pearson(a, 2.5 * a - 7.0) == pytest.approx(1.0, abs=1e-14)
    assert pearson(a, -a) == pytest.approx(-1.0, abs=1e-14)
    assert psi(a, -a) == pytest.approx(4.0)


def test_what_does_not_move_has_no_R_and_no_number_in_the_json() -> None:
    flat = score(np.ones(100), np.ones(100), 5e-4).to_json()
    assert flat["R"] is None
    assert flat["nrmse"] is None
    assert flat["gain"] is None
    assert flat["lag_s"] is None


def test_gain_and_nrmse_say_what_R_does_not() -> None:
    a, _ = pair()
    scored = score(a, 1.1 * a, 5e-4)
    assert pytest.approx(1.0) == scored.R
    assert scored.gain == pytest.approx(1.1)
    assert scored.nrmse == pytest.approx(math.sqrt(np.mean((0.1 * a) ** 2)) / np.ptp(a))
    assert scored.peak_error == pytest.approx(0.1 * a.max())


@pytest.mark.parametrize("lag", [-0.0123, -0.0002, 0.00037, 0.008])
def test_the_lag_is_found_to_a_fraction_of_a_sample_and_is_positive_where_the_simulation_is_late(lag: float) -> None:
    def signal(t: np.ndarray) -> np.ndarray:
        return np.sin(2 * np.pi * 3 * t) + 0.4 * np.sin(2 * np.pi * 11 * t + 1)

    assert best_lag(signal(TIME), signal(TIME - lag), 5e-4) == pytest.approx(lag, abs=5e-6)


def test_eight_milliseconds_of_lag_ruin_R_at_twenty_hertz() -> None:
    assert pearson(np.sin(40 * np.pi * TIME), np.sin(40 * np.pi * (TIME - 0.008))) == pytest.approx(0.536, abs=2e-3)


def test_noise_has_no_lag() -> None:
    rng = np.random.default_rng(0)
    assert math.isnan(best_lag(rng.standard_normal(4000), rng.standard_normal(4000), 5e-4))


@pytest.mark.parametrize("block", [1, 7, 20, 5000])
def test_streamed_R_is_the_R_of_the_whole(block: int) -> None:
    a, b = pair()
    stream = StreamR()
    for i in range(0, len(a), block):
        R = stream.push(a[i : i + block], b[i : i + block])
    assert pytest.approx(pearson(a, b), abs=1e-14) == R
    assert stream.nrmse == pytest.approx(score(a, b, 5e-4).nrmse, rel=1e-12)


def test_an_hour_of_a_small_motion_far_from_zero_costs_no_digit() -> None:
    rng, stream = np.random.default_rng(2), StreamR()
    a = 1000.0 + 1e-3 * np.sin(np.arange(200_000) * 0.01)
    b = a + 1e-5 * rng.standard_normal(len(a))
    for _ in range(36):
        for i in range(0, len(a), 20_000):
            stream.push(a[i : i + 20_000], b[i : i + 20_000])
    p, q = (v.astype(np.longdouble) - np.longdouble(1000.0) for v in (a, b))
    p, q = p - p.mean(), q - q.mean()
    assert stream.count == 7_200_000
    assert abs(stream.R - float((p * q).sum() / np.sqrt((p * p).sum() * (q * q).sum()))) < 1e-12


def test_the_window_forgets_what_left_it_to_the_last_digit() -> None:
    a, b = pair()
    a[:5000] *= 1e6
    window = SlidingR(3000)
    for i in range(0, len(a), 33):
        R = window.push(a[i : i + 33], b[i : i + 33])
    assert pytest.approx(pearson(a[-3000:], b[-3000:]), abs=1e-12) == R
    assert np.array_equal(window.samples()[0], a[-3000:])
