"""What no cause explains is said, with where it acts and on what it depends."""

from __future__ import annotations

from pathlib import Path

from mocks.plant.motion import Motion
from mocks.plant.operator import draw_stand
from mocks.record import Hidden, record
from stand.recording import Recording, read_recording
from twin.diagnosis import Options, diagnose
from twin.diagnosis.audit import audit_all
from twin.diagnosis.latent import terms
from twin.diagnosis.misfit import error
from twin.diagnosis.problem import Problem
from twin.diagnosis.run import choose, prepare
from twin.diagnosis.search import calibrate
from twin.diagnosis.unknown import refitted


def _runs(folder: Path, hidden: Hidden) -> list[Recording]:
    motions = (Motion("trapezoidal", 1.25, 0.05, 0.3), Motion("quasi-sinusoidal", 1.0, 0.06))
    paths = [
        record(draw_stand(71), motion, path=folder / f"{i}.h5", seconds=8.0, seed=71 + i, hidden=hidden)
        for i, motion in enumerate(motions)
    ]
    return [read_recording(path) for path in paths]


def test_a_screw_of_fine_pitch_is_seen_where_it_acts(tmp_path: Path) -> None:
    hidden = {"drive-pitch-error": {"amplitude": 1.2e-4, "pitch": 0.0052, "phase": 0.4}}
    runs = tuple(prepare(r) for r in audit_all(_runs(tmp_path, hidden), ())[0])
    problem = Problem(runs, choose(runs, 12))
    base = calibrate(problem)
    found = terms(problem, base)[0]
    assert (found.place, found.variable) == ("drive", "drive_position")
    assert found.x[1] - found.x[0] < 0.0052 / 3, "knots too far apart for the pitch"
    learned = refitted(problem, base, found)
    assert learned is not None
    before, after = (error(problem, f.residual).max() for f in (base, learned))
    assert after < 0.05 * before, "the term that was seen was not learned"


def test_where_much_is_wrong_and_nothing_fits_something_is_said(tmp_path: Path) -> None:
    drag = {"guide-viscous-drag": {"coefficient": 12.0}}
    told = diagnose(_runs(tmp_path, drag), options=Options(windows=10, searched=6, causes=("mains-hum",))).to_json()
    assert told["causes"] == []
    assert told["unknown"] is not None
    assert told["unknown"]["acts_on"] in ("guide", "pulley", "fibre")
