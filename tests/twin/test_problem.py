"""Windows' starts as instruments and causes tell them, and what follows from them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import twin.causes
from mocks.plant.motion import Motion
from mocks.plant.operator import draw_stand
from mocks.record import record
from stand.recording import read_recording
from stand.setup import System
from tests.twin.exact import SLOW, THROWN, exact
from twin.causes._kind import Cause
from twin.diagnosis.audit import audit_all
from twin.diagnosis.composition import Composition
from twin.diagnosis.direct import screen
from twin.diagnosis.engine import known
from twin.diagnosis.finish import finished, regained
from twin.diagnosis.fit import fit, residual
from twin.diagnosis.misfit import misses
from twin.diagnosis.problem import Problem
from twin.diagnosis.run import choose, prepare
from twin.plugins import load


def test_a_start_does_not_jump_where_a_delay_passes_half_a_sample(tmp_path: Path) -> None:
    motion = Motion("trapezoidal", 1.5, 0.05, 0.2)
    path = record(draw_stand(61), motion, path=tmp_path / "run.h5", seconds=4.0, seed=61, hidden={})
    runs = tuple(prepare(r) for r in audit_all([read_recording(path)], ())[0])
    problem = Problem(runs, choose(runs, 12))
    cause = load(twin.causes, "dial-gauge-delay", Cause)
    model, none = Composition((runs[0].setup,), (cause,)), np.zeros((len(problem.windows), 4))

    def starts(delay: float) -> np.ndarray:
        return problem.simulate(model, model.put(model.zero(), cause, {"delay": delay}), none)[0][:, 0, 0]

    before, after = starts(0.2499e-3), starts(0.2501e-3)
    assert len(before) >= 4
    assert np.abs(after - before).max() < 3e-7  # m: at most 1.5 m/s for 0.2 us
    assert np.abs(starts(0.5e-3) - before).max() > 5e-6  # the delay itself is undone


WITH_MEMORY = {
    "fibre-creep": {"compliance": 4e-5, "time_constant": 1.2},
    "fibre-viscoelasticity": {"stiffness": 8000.0, "time_constant": 0.15},
    "fibre-hysteresis": {"stiffness": 6000.0, "yield_elongation": 0.0004},
    "drive-compliance": {"compliance": 6e-6},
    "pulley-bearing-friction": {"coefficient": 0.03},
    "fibre-pulley-slip": {"friction": 0.3},
}


@pytest.mark.parametrize("name", WITH_MEMORY)
def test_with_a_causes_true_values_windows_are_predicted_to_the_noise(name: str, tmp_path: Path) -> None:
    problem = exact(tmp_path, {name: WITH_MEMORY[name]}, (SLOW, THROWN))
    cause = load(twin.causes, name, Cause)
    model = Composition(tuple(r.setup for r in problem.runs), (cause,))
    z = model.put(model.zero(), cause, WITH_MEMORY[name])
    fitted = fit(problem, model, z, iterations=3, fixed=np.ones(len(z), bool))
    for run in range(2):
        mine = np.flatnonzero(problem.windows.run == run)
        assert len(mine) >= 8
        each = misses(problem, fitted.residual)[mine]
        assert np.quantile(each, 0.75, axis=0).max() < 1.3  # one sample at a snatch is enough to spoil a window's mean
        assert np.sqrt(np.mean(fitted.starts[mine] ** 2)) < 0.72  # 0.78 to 1.2 where a slack fibre's rim is still


def test_a_base_value_far_from_what_is_stated_leads_the_direct_screen(tmp_path: Path) -> None:
    soft = {"fibre-stiffness": {"difference": -0.8 * draw_stand(62).believed.fibre_stiffness}}
    problem = exact(tmp_path, soft, (SLOW, THROWN))
    model = Composition(tuple(r.setup for r in problem.runs), ())
    ranked = screen(problem, model, model.zero(), known(System.WFPD))
    assert ranked[0].cause.name == "fibre-stiffness"


def test_a_drifting_gauges_slack_stretches_start_no_window(tmp_path: Path) -> None:
    """After six seconds the slack fibre seems to pull with more than the 4 N from which it counts as taut."""
    (tmp_path / "true").mkdir()
    drifting = exact(tmp_path, {"force-gauge-drift": {"rate": 0.9}}, (THROWN,))
    true = exact(tmp_path / "true", {}, (THROWN,)).runs[0].raw_F
    slack = true < 1.0
    assert np.mean(slack[10_000:]) > 0.4
    assert len(drifting.windows) >= 12
    assert not slack[drifting.windows.first].any()


def test_a_fit_that_calibration_left_bent_is_finished_at_the_true_values(tmp_path: Path) -> None:
    problem = exact(tmp_path, {"pulley-bearing-drag": {"coefficient": 8.4}}, (SLOW, THROWN))
    cause = load(twin.causes, "pulley-bearing-drag", Cause)
    model = Composition(tuple(r.setup for r in problem.runs), (cause,))
    z = model.put(model.zero(), cause, {"coefficient": 8.9})
    z[[model.index["base", "split"], model.index["base", "pulley_inertia"]]] = 3.0, -2.0
    done = finished(problem, fit(problem, model, z, iterations=2))
    assert model.values(done.z, cause)["coefficient"] == pytest.approx(8.4, rel=0.02)
    assert abs(done.z[model.index["base", "split"]]) < 2.0


def test_a_window_gone_astray_is_started_once_more(tmp_path: Path) -> None:
    problem = exact(tmp_path, {}, (THROWN,))
    model = Composition(tuple(r.setup for r in problem.runs), ())
    fitted = fit(problem, model, model.zero(), iterations=4, fixed=np.ones(len(model.zero()), bool))
    starts = fitted.starts.copy()
    starts[3] += (0.0, 0.0, 8.0, 8.0)
    stray = replace(fitted, starts=starts, residual=residual(problem, model, fitted.z, starts))
    assert misses(problem, stray.residual)[3].max() > 3.0
    found = regained(problem, stray)
    assert misses(problem, found.residual)[3].max() < 1.1 * misses(problem, fitted.residual)[3].max()
    assert regained(problem, fitted) is fitted, "nothing was astray"


def test_a_fit_stuck_at_too_small_a_cause_is_begun_again_with_a_larger(tmp_path: Path) -> None:
    problem = exact(tmp_path, {"pulley-bearing-drag": {"coefficient": 8.4}}, (SLOW, THROWN))
    cause = load(twin.causes, "pulley-bearing-drag", Cause)
    model = Composition(tuple(r.setup for r in problem.runs), (cause,))
    z = model.put(model.zero(), cause, {"coefficient": 2.0})
    z[[model.index["base", "split"], model.index["base", "pulley_inertia"]]] = -2.1, -2.9
    done = finished(problem, fit(problem, model, z, iterations=2))
    assert model.values(done.z, cause)["coefficient"] == pytest.approx(8.4, rel=0.03)


def test_what_was_asked_before_changes_no_answer(tmp_path: Path) -> None:
    problem = exact(tmp_path, {"fibre-creep": WITH_MEMORY["fibre-creep"]}, (SLOW, THROWN))
    causes = tuple(load(twin.causes, n, Cause) for n in ("fibre-creep", "force-gauge-scale"))
    model = Composition(tuple(r.setup for r in problem.runs), causes)
    z = model.put(model.zero(), causes[0], WITH_MEMORY["fibre-creep"])
    starts = np.zeros((len(problem.windows), 4))
    first = problem.predict(model, z, starts).copy()
    z[model.index["force-gauge-scale", "gain"]] += 0.5
    scaled = problem.predict(model, z, starts).copy()
    starts[:, 0] += 1.0
    moved = problem.predict(model, z, starts)
    assert np.abs(scaled - first).max() > 1e-3
    assert np.abs(moved - scaled).max() > 1e-8
    fresh = Problem(problem.runs, problem.windows)
    assert np.array_equal(fresh.predict(model, z, starts), moved)
