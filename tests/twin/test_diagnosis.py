"""The diagnosis names what an axis hides, stays silent on a clean one, and refuses what it can't use."""

import json
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stand.errors import InputError
from stand.recording import Recording
from stand.setup import Setup, System
from twin.diagnosis import Options, diagnose
from twin.diagnosis.audit import audit
from twin.diagnosis.rivals import trust
from twin.diagnosis.smooth import noise, smooth


def axis(drag: float = 0.0, offset: float = 0.0, mass: float = 12.0) -> Recording:
    """A mass on a guide under a known force, by small steps of its own; 4 s at 2 kHz with noise."""
    rng, dt, n, pieces = np.random.default_rng(5), 5e-4, 8000, 4
    time = np.arange(n) * dt
    force = sum(a * np.sin(2 * np.pi * f * time + p) for a, f, p in ((30, 1.1, 0), (20, 2.3, 1), (15, 4.1, 2)))
    force[:800] = 0.0
    x, place, speed = np.zeros(n), 0.0, 0.0
    for i in range(n - 1):
        for j in range(pieces):
            now = force[i] + (j + 0.5) / pieces * (force[i + 1] - force[i])
            speed += (now - drag * speed) / mass * dt / pieces
            place += speed * dt / pieces
        x[i + 1] = place
    setup = Setup(system=System.LINEAR_DRIVE, moving_mass=12.1, uncertainty={"moving_mass": 0.12})
    channels = {"drive_position": x + rng.normal(0, 5e-6, n), "drive_force": force + offset + rng.normal(0, 0.05, n)}
    return Recording(None, setup, time, channels)


QUICK = Options(windows=16, searched=6, causes=("guide-viscous-drag", "guide-quadratic-drag", "force-gauge-offset"))


def test_a_clean_axis_is_left_in_peace() -> None:
    verdict = diagnose([axis()], options=QUICK).to_json()
    assert verdict["causes"] == []
    assert verdict["unknown"] is None
    assert verdict["model"] is None


def test_a_viscous_drag_is_named_with_its_size_and_the_verdict_is_json() -> None:
    verdict = diagnose([axis(drag=15.0)], options=QUICK)
    assert verdict.causes[:1] == ("guide-viscous-drag",)
    cause = verdict.to_json()["causes"][0]
    assert cause["parameters"]["coefficient"]["value"] == pytest.approx(15.0, rel=0.03)
    assert verdict.to_json()["gain"]["prediction_error_ratio"] < 0.3
    json.dumps(verdict.to_json(), allow_nan=False)


@pytest.mark.parametrize(("before", "after", "low", "high"), [
    (50.0, 1.0, 0.97, 0.99),  # all of it explained
    (50.0, 1.9, 0.95, 0.98),  # nearly all
    (1.40, 1.3, 0.2, 0.4),  # less taken away than left
    (1.3, 1.3, 0.0, 0.01),
])  # fmt: skip
def test_a_cause_is_believed_by_what_it_takes_away_against_what_is_left(
    before: float, after: float, low: float, high: float
) -> None:
    windows, samples = 20, 50
    problem = SimpleNamespace(
        sigma=np.ones((windows, 2)), windows=SimpleNamespace(use=np.ones((windows, samples, 2), bool))
    )
    without, final = (SimpleNamespace(residual=np.full((windows, samples, 2), np.sqrt(e))) for e in (before, after))
    search: Any = SimpleNamespace(problem=problem, current=final, lacking=lambda causes: [without])
    assert low <= trust(search, search) <= high


def test_a_slow_recorder_is_no_fault_of_the_axis() -> None:
    def thinned(whole: Recording) -> Recording:
        return replace(whole, time=whole.time[::8], channels={n: v[::8] for n, v in whole.channels.items()})

    assert diagnose([thinned(axis())], options=QUICK).to_json()["causes"] == []
    found = diagnose([thinned(axis(drag=15.0))], options=QUICK).to_json()["causes"]
    assert [c["name"] for c in found] == ["guide-viscous-drag"]
    assert found[0]["parameters"]["coefficient"]["value"] == pytest.approx(15.0, rel=0.05)


def test_a_damaged_file_of_a_campaign_is_skipped_and_listed() -> None:
    good, bad = axis(), axis()
    dead = replace(bad, channels={**bad.channels, "drive_position": np.zeros(len(bad.time))})
    verdict = diagnose([good, dead], options=QUICK).to_json()
    assert len(verdict["baseline"]["skipped"]) == 1
    assert "constant" in verdict["baseline"]["skipped"][0]["why"]


def test_a_few_missing_samples_are_bridged_and_many_are_refused() -> None:
    recording = axis()
    holed = recording.channels["drive_position"].copy()
    holed[1000:1010] = np.nan
    mended, notes = audit(replace(recording, channels={**recording.channels, "drive_position": holed}))
    assert np.all(np.isfinite(mended.x))
    assert "bridged" in notes[0]
    holed[1000:3000] = np.nan
    with pytest.raises(InputError, match="not numbers"):
        audit(replace(recording, channels={**recording.channels, "drive_position": holed}))


def test_noise_is_told_from_motion_and_smoothing_takes_most_of_it() -> None:
    time = np.arange(8000) * 5e-4
    clean = 0.015 * (1 - np.cos(2 * np.pi * 1.5 * np.clip(time - 1, 0, 2)))  # from rest to rest, as runs are
    dirty = clean + np.random.default_rng(1).normal(0, 6e-6, len(time))
    assert noise(dirty) == pytest.approx(6e-6, rel=0.05)
    inner = slice(200, -200)
    assert np.std(smooth(dirty, 5e-4, 6e-6).value[inner] - clean[inner]) < 2e-6
