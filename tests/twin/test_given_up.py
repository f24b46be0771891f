"""A fit that can't come near another is given up, and says so; one that can is as it would have been."""

from __future__ import annotations

import numpy as np
import pytest

import twin.causes
from tests.twin.exact import SLOW, THROWN, exact
from twin.causes._kind import Cause
from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import Fitted, fit, shortfall
from twin.diagnosis.problem import Problem
from twin.plugins import load

DRAG = {"coefficient": 8.4}
LONG = 12


@pytest.fixture(scope="module")
def problem(tmp_path_factory: pytest.TempPathFactory) -> Problem:
    return exact(tmp_path_factory.mktemp("runs"), {"pulley-bearing-drag": DRAG}, (SLOW, THROWN))


def _with(problem: Problem, name: str) -> Composition:
    return Composition(tuple(r.setup for r in problem.runs), (load(twin.causes, name, Cause),))


@pytest.fixture(scope="module")
def true(problem: Problem) -> Fitted:
    model = _with(problem, "pulley-bearing-drag")
    return fit(problem, model, model.put(model.zero(), model.causes[0], DRAG), iterations=4)


def test_another_cause_is_given_up(problem: Problem, true: Fitted) -> None:
    model = _with(problem, "fibre-mass")
    z = model.zero()
    alone = fit(problem, model, z, iterations=LONG)
    assert shortfall(problem, alone, true) > 0.0
    assert not alone.given_up
    assert fit(problem, model, z, iterations=LONG, against=true).given_up


def test_the_right_cause_is_not_and_ends_where_it_does_alone(problem: Problem, true: Fitted) -> None:
    model = _with(problem, "pulley-bearing-drag")
    z = model.put(model.zero(), model.causes[0], {"coefficient": 7.0})
    alone, against = (fit(problem, model, z, iterations=LONG, against=other) for other in (None, true))
    assert shortfall(problem, against, true) < 0.0
    assert not against.given_up
    assert np.array_equal(against.z, alone.z)
