"""A hum of the mains is found where the stand rests, and where it truly rests alone."""

from __future__ import annotations

import numpy as np
import pytest

from stand.recording import Recording
from stand.setup import nominal
from twin.diagnosis.hum import find


def run(seed: int, hum: float = 0.0, swing: float = 0.0) -> Recording:
    """6 s with a motion from 1 to 4.5 s; m of hum in u, m of the weight's swing when the drive stands again."""
    rng, time = np.random.default_rng(seed), np.arange(12000) / 2000
    x = 0.01 * (1 - np.cos(2 * np.pi * 2.0 * np.clip(time - 1.0, 0.0, 3.5)))
    after = np.clip(time - 4.5, 0.0, None)
    u = x + swing * np.sin(2 * np.pi * 16.7 * after) * np.exp(-0.5 * after)
    u = u + hum * np.sin(2 * np.pi * 50.04 * time + seed) + rng.normal(0, 5e-6, len(time))
    channels = {"drive_position": x, "weight_position": u, "fibre_force": 15.2 + rng.normal(0, 0.1, len(time))}
    return Recording(None, nominal(), time, channels)


@pytest.mark.parametrize("swing", [0.0, 3e-3])
def test_a_hum_is_found_also_where_a_weight_still_swings_at_the_end_of_a_run(swing: float) -> None:
    runs = [run(1, 13e-6), run(2, 13e-6, swing), run(3, 13e-6)]
    cleaned, lines = find(runs)
    assert [line.signal for line in lines] == ["weight_position"]
    assert lines[0].frequency == pytest.approx(50.04, abs=0.01)
    assert lines[0].amplitude == pytest.approx(13e-6, rel=0.05)
    rest = slice(0, 1800)
    assert np.std(cleaned[0].channels["weight_position"][rest]) == pytest.approx(5e-6, rel=0.1)


def test_a_weight_that_swings_is_no_hum() -> None:
    assert find([run(k, swing=3e-3) for k in range(3)])[1] == []
