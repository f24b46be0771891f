"""How much better each cause at each of several sizes predicts at once, without any refit.

Where a cause is strong, calibration bends every base value to make up for it and first-order scores taken there
mislead;
the setup as stated does not, and a delay or an end stop then shows by itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from twin.causes._kind import Cause, Survey
from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import loss, residual, scale
from twin.diagnosis.problem import Problem
from twin.diagnosis.score import Scored, survey

Float = NDArray[np.float64]

#: shares of a stated value at which a base value is tried that may be far from it: first order sees no such distance
FAR = (0.2, 0.5, 2.0, 4.0)


def sizes(cause: Cause, reach: Survey, stated: float) -> Iterator[Mapping[str, float]]:
    """The trials of a cause at several sizes of its first parameter, both signs where it may have them; of a base
    value, shares of what is stated.
    """
    first = cause.parameters[0]
    if cause.base is not None:
        yield from ({first.name: (share - 1.0) * stated} for share in FAR if stated > 0)
        return
    grows = first.name not in ("position", "level", "friction", "frequency", "width")
    for values in cause.trials(reach):
        size = values[first.name] - first.value
        factors = (1.0,) if not grows else ((1.0, 4.0) if cause.scan else (0.3, 1.0, 3.0))
        for factor in factors:
            for sign in (1.0, -1.0):
                value = first.value + sign * factor * size
                if first.bounds[0] <= value <= first.bounds[1] and (sign > 0 or grows):
                    yield {**values, first.name: value}


def screen(problem: Problem, model: Composition, z: Float, causes: Iterable[Cause]) -> list[Scored]:
    """Causes by how much the robust loss falls with each at its best size, best first; z and zero starts elsewhere."""
    starts = np.zeros((len(problem.windows), 4))
    here = residual(problem, model, z, starts)
    spread = scale(problem, here)
    before, reach, found = loss(here, spread), survey(problem), []
    for cause in causes:
        stated = float(getattr(model.setups[0], cause.base)) if cause.base else 0.0
        if cause.base and ("base", cause.base) not in model.index:
            continue
        extended = Composition(model.setups, (*model.causes, cause))
        carried = model.carry(z, extended)
        trials = []
        for values in sizes(cause, reach, stated):
            left = residual(problem, extended, extended.put(carried, cause, values), starts)
            trials.append((before - loss(left, spread), 1.0, values))
        found.append(Scored(cause, tuple(sorted(trials, key=lambda t: -t[0])[:2])))
    return sorted((s for s in found if s.gain > 0), key=lambda s: -s.gain)
