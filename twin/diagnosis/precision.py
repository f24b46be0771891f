"""How sure a fit is of its parameters."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from twin.diagnosis.coordinates import STATED
from twin.diagnosis.fit import STEP, Fitted, slopes
from twin.diagnosis.normal import Linear, reduce
from twin.diagnosis.problem import Problem

Float = NDArray[np.float64]
#: what a model's form costs, as a share of a size, and what the windows tell too well
FORM, WINDOWS = 0.0025, 1.5
#: share of a window's slopes by which those forward and backward may differ
TORN = 0.05


def steady(problem: Problem, fitted: Fitted) -> Linear:
    """A fit's slopes without those of windows that jump there, where steps forward and backward disagree.

    By a single one of them a fit would be sure of what nothing tells.
    """
    linear = slopes(problem, fitted)
    back = slopes(problem, fitted, linear, -STEP)
    change, size = (np.sqrt(np.sum(c**2, axis=2)) for c in (linear.columns - back.columns, linear.columns))
    linear.columns[:, (change > TORN * size + 1.0).any(axis=0)] = 0.0
    return linear


def covariance(problem: Problem, fitted: Fitted) -> tuple[Float, Float]:
    """Covariance of z, and the same without priors' share of knowledge; windows are the independent pieces.

    The windows' own scores say how much the fit would move (a sandwich), so noise that is not white, noise of x and
    small faults of the model count; priors enter as measurements of their own.
    """
    linear = steady(problem, fitted)
    reduced = reduce(linear, fitted.starts, fitted.z)
    own = linear.starts.transpose(1, 0, 2)
    right = np.einsum("wsl,wl->ws", own, linear.residual)
    solved = np.linalg.solve(reduced.starts_matrix, right[..., None])[..., 0]
    pieces = np.einsum("pwl,wl->wp", linear.columns, linear.residual) - np.einsum("wps,ws->wp", reduced.cross, solved)
    pieces -= pieces.mean(axis=0)
    meat = pieces.T @ pieces + np.diag(linear.prior)
    low, high = fitted.model.low, fitted.model.high
    base = np.array([c.owner in STATED for c in fitted.model.coordinates])  # at its limit it is still uncertain
    inside = base | ((fitted.z > low + 1e-9) & (fitted.z < high - 1e-9))
    inside &= np.diag(reduced.matrix) > 1e-12
    bread = np.zeros_like(meat)
    bread[np.ix_(inside, inside)] = np.linalg.pinv(reduced.matrix[np.ix_(inside, inside)], rcond=1e-13)
    sandwich = bread @ meat @ bread
    return sandwich, bread


def stated(sandwich: float, size: float, base: float = 0.0) -> float:
    """The one sigma that is told of a parameter whose distance from null is `size`.

    What the windows tell, and what a model's form costs beyond them: measured on simulated stands of other equations,
    a size is off by FORM of itself where the windows alone claim far less. base: what the setup's own values add.
    """
    return float(np.hypot(np.hypot(WINDOWS * sandwich, FORM * size), base))
