"""A fit taken to its very end: a further cause must not be credited with what it lacked."""

from __future__ import annotations

from twin.diagnosis.fit import FINE, Fitted, fit
from twin.diagnosis.misfit import error, ranked
from twin.diagnosis.problem import Problem

#: squared error in the sensors' noise below which there is nothing to finish, and iterations of a long fit
NEARLY, LONG = 1.015, 12


def finished(problem: Problem, fitted: Fitted) -> Fitted:
    """The fit gone on with where something is left, once more from the base values as stated, the better of both.

    What calibration bent before the causes were there can stay bent where snatches make the cost rough.
    """
    if error(problem, fitted.residual).max() < NEARLY:
        return fitted
    model = fitted.model
    ends = []
    for z, starts in ((fitted.z, fitted.starts), (model.unbent(fitted.z), None)):
        problem.forget_states()
        ends.append(fit(problem, model, z, starts, iterations=LONG, tolerance=FINE))
    return ranked(problem, ends)[0]
