"""What is hidden in short recordings of another plant must be named, with its size; nothing where nothing is hidden."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from mocks.plant.motion import Motion
from mocks.plant.operator import draw_stand
from mocks.record import Hidden, record
from stand.recording import read_recording
from twin.diagnosis import diagnose

FAST = Motion("trapezoidal", 1.5, 0.05, 0.2)
GENTLE = Motion("trapezoidal", 1.25, 0.035, 0.3)
SLOW = Motion("quasi-sinusoidal", 0.5, 0.05)
PUBLISHED = {"velocity-dependent-damping": {"slope": 385.0, "threshold": 0.4}}


def verdict(folder: Path, motion: Motion, seed: int, hidden: Hidden, *, stick: bool = False) -> dict[str, Any]:
    """The verdict on one run of 6 s of a stand whose operator is a little wrong about everything."""
    stand = draw_stand(seed)
    if stick:
        stand = replace(stand, true=stand.true.but(guide_friction_velocity=0.0))
    path = record(stand, motion, path=folder / "run.h5", seconds=6.0, seed=seed, hidden=hidden)
    return diagnose([read_recording(path)]).to_json()


def test_the_published_damping_is_named_with_both_constants_within_ten_per_cent(tmp_path: Path) -> None:
    told = verdict(tmp_path, FAST, 61, PUBLISHED)
    assert [c["name"] for c in told["causes"]] == ["velocity-dependent-damping"]
    sizes = told["causes"][0]["parameters"]
    assert sizes["slope"]["value"] == pytest.approx(385.0, rel=0.1)
    assert sizes["threshold"]["value"] == pytest.approx(0.4, rel=0.1)
    assert told["unknown"] is None
    assert told["gain"]["prediction_error_noise_units"] < 1.3


def test_slow_runs_cannot_tell_the_published_damping_and_the_run_that_can_is_proposed(tmp_path: Path) -> None:
    told = verdict(tmp_path, SLOW, 62, PUBLISHED)
    assert told["causes"] == []
    assert told["unknown"] is None
    assert "velocity-dependent-damping" in told["next_experiment"]["separates"]


def test_a_drag_is_named_and_its_size_lies_within_its_error(tmp_path: Path) -> None:
    told = verdict(tmp_path, GENTLE, 63, {"guide-viscous-drag": {"coefficient": 8.0}})
    assert told["causes"][0]["name"] == "guide-viscous-drag"
    size = told["causes"][0]["parameters"]["coefficient"]
    assert abs(size["value"] - 8.0) < max(3 * size["std"], 0.4)


def test_a_clean_stand_whose_friction_truly_sticks_is_left_in_peace(tmp_path: Path) -> None:
    told = verdict(tmp_path, FAST, 64, {}, stick=True)
    assert told["causes"] == []
    assert told["unknown"] is None
    assert told["model"] is None
