"""Windows' starts as their instruments tell them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import twin.causes
from mocks.plant.motion import Motion
from mocks.plant.operator import draw_stand
from mocks.record import record
from stand.recording import read_recording
from twin.causes._kind import Cause
from twin.diagnosis.audit import audit_all
from twin.diagnosis.composition import Composition
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
