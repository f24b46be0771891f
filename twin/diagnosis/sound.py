"""Whether a cause that a fit took in may stay."""

from __future__ import annotations

import numpy as np

from stand.setup import System
from twin.causes._kind import Cause
from twin.diagnosis.clipped import GUIDE_END, PASSED
from twin.diagnosis.coordinates import NO_FRICTION
from twin.diagnosis.finish import REACHED
from twin.diagnosis.fit import Fitted
from twin.diagnosis.misfit import error, gained
from twin.diagnosis.precision import covariance
from twin.diagnosis.problem import Problem
from twin.diagnosis.score import survey

#: share of a channel's squared error that a cause has to take away
NEEDED = 0.012
#: a further cause that is true leaves neither channel with so many times the squared error it had
SPOILT = 1.5


def sound(problem: Problem, before: Fitted, after: Fitted) -> bool:
    """Whether the last cause of a fit is needed, spoils no channel, and is more than 3 sigma from null and within
    reason.
    """
    first, old = not before.model.causes, error(problem, before.residual)
    if not first and (error(problem, after.residual) > SPOILT * np.maximum(old, 1.0)).any():
        return False
    excess = float(old.max()) - 1.0
    needed = NEEDED if first else max(NEEDED, 0.2 * excess / (1.0 + excess))
    if gained(problem, before, after) < needed:
        return False
    cause = after.model.causes[-1]
    i = after.model.place(cause, cause.parameters[0].name)
    spread, _ = covariance(problem, after)
    size, sigma = abs(after.z[i]), float(np.sqrt(max(spread[i, i], 0.0)))
    if cause.base:
        axis = problem.system is System.LINEAR_DRIVE and cause.base == "guide_friction"
        return bool(size > 3.0 * np.hypot(NO_FRICTION if axis else 1.0, sigma))
    reached = cause.parameters[0].name in REACHED or cause.name == "force-gauge-resonance"
    return bool(reached or size > 3.0 * sigma) and _within_reason(problem, after, cause)


def _within_reason(problem: Problem, fitted: Fitted, cause: Cause) -> bool:
    """A patch is narrower than the travel, a stop stands before the guide's own end."""
    values = fitted.model.values(fitted.z, cause)
    if cause.name == "end-stop":
        return abs(values["position"]) < GUIDE_END - PASSED or problem.system is System.LINEAR_DRIVE
    if cause.name != "guide-rough-patch":
        return True
    low, high = survey(problem).u
    return (
        values["width"] < 0.6 * (high - low)
        and low - 0.5 * values["width"] < values["centre"] < high + 0.5 * values["width"]
    )
