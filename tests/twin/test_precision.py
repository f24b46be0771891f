"""How sure a fit says it is."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import twin.causes
from mocks.plant.motion import Motion
from tests.twin.exact import exact
from twin.causes._kind import Cause
from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import fit
from twin.diagnosis.precision import covariance
from twin.plugins import load

SNATCHING = Motion("rectangular", 1.0, 0.05, 0.0), Motion("trapezoidal", 1.5, 0.05, 0.2)


def test_a_force_gauges_gain_is_known_no_better_than_the_weights(tmp_path: Path) -> None:
    """All forces and masses alike are all that moves nothing, also in windows that jump at the smallest step."""
    problem = exact(tmp_path, {"force-gauge-scale": {"gain": 1.15}}, SNATCHING, windows=40, seed=70)
    cause = load(twin.causes, "force-gauge-scale", Cause)
    model = Composition(tuple(r.setup for r in problem.runs), (cause,))
    fitted = fit(problem, model, model.put(model.zero(), cause, {"gain": 1.15}), iterations=6)
    spread, _ = covariance(problem, fitted)
    i = model.index["force-gauge-scale", "gain"]
    sigma = np.sqrt(spread[i, i]) * model.coordinates[i].scale / 1.15
    setup = problem.runs[0].setup
    weights = setup.sigma("weight_mass") / setup.weight_mass
    assert 0.4 * weights < sigma < 1.5 * weights, (sigma, weights)
