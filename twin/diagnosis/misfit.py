"""How far a fit misses: per window, per channel, against another fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from twin.diagnosis.fit import Fitted, loss, scale
from twin.diagnosis.problem import Problem

Float = NDArray[np.float64]
WILD = 25.0


def error(problem: Problem, left: Float, wild: float = WILD) -> Float:
    """Squared short-window error in the sensors' noise, per channel [2]: the mean over the windows that have the
    channel, the wildest tenth capped where it passes `wild`.
    """
    each, has = misses(problem, left), problem.windows.use.sum(axis=1) > 0
    mean = np.zeros(2)
    for c in range(2):
        mine = each[has[:, c], c]
        if len(mine):
            mean[c] = np.minimum(mine, max(float(np.percentile(mine, 90)), wild)).mean()
    return mean


def gained(problem: Problem, before: Fitted, after: Fitted) -> float:
    """The share by which the squared short-window error falls, in the channel where it falls most."""
    old, new = error(problem, before.residual), error(problem, after.residual)
    return float(np.max((old - new) / np.maximum(old, 1e-12)))


def misses(problem: Problem, left: Float) -> Float:
    """Squared error of every window in the sensors' noise [w, 2]."""
    squares = ((left / problem.sigma[:, None, :]) ** 2).sum(axis=1)
    each: Float = squares / np.maximum(problem.windows.use.sum(axis=1), 1)
    return each


def ranked(problem: Problem, fits: Sequence[Fitted]) -> list[Fitted]:
    """Best first, all on the scale of the one that leaves least."""
    if not fits:
        return []
    spread = np.min([scale(problem, f.residual) for f in fits], axis=0)
    return sorted(fits, key=lambda f: loss(f.residual, spread) + prior_price(f))


def prior_price(fitted: Fitted) -> float:
    """What priors and the number of parameters cost."""
    priors = np.array([c.prior for c in fitted.model.coordinates])
    free = sum(len(c.parameters) for c in fitted.model.causes)
    return float(np.sum((fitted.z / priors) ** 2)) + 20.0 * free
