"""What the demo hides can be seen in the run that it makes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from api.cli.demo import WITHIN_REACH
from mocks.config import parse_hide
from mocks.plant.motion import Motion
from mocks.plant.operator import draw_stand
from mocks.record import record
from stand.recording import read_recording
from twin.diagnosis import diagnose


def test_an_effect_that_begins_at_a_speed_is_reached_by_the_demos_motion(tmp_path: Path) -> None:
    stand, hidden = draw_stand(62), parse_hide([WITHIN_REACH["velocity-dependent-damping"]])
    motion = Motion("trapezoidal", 1.6, 0.03, 0.2)
    path = record(
        replace(stand, true=stand.believed), motion, path=tmp_path / "run.h5", seconds=10.0, seed=4, hidden=hidden
    )
    causes = diagnose([read_recording(path)]).to_json()["causes"]
    assert [c["name"] for c in causes] == ["velocity-dependent-damping"]
