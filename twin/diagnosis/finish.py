"""A fit taken to its very end: neither a further cause nor a rival must be credited with what it lacked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import FINE, Fitted, fit
from twin.diagnosis.misfit import error, misses, ranked
from twin.diagnosis.problem import Problem

Float = NDArray[np.float64]
#: squared error in the sensors' noise below which there is nothing to finish, and iterations of a long fit
NEARLY, LONG = 1.015, 12
#: squared error at which a fit may be stuck, and the sizes of its last cause from which it is begun again
STUCK, SIZES = 1.2, (1.6, 0.6)
#: first parameters that say where an effect begins, not how large it is
REACHED = frozenset({"level", "position", "friction"})
#: a window gone astray misses by so much, and by so many times the others', in the noise squared; they are few
ASTRAY, BEYOND, SHARE = 1.7, 1.5, 0.15


def finished(problem: Problem, fitted: Fitted) -> Fitted:
    """The fit taken to its end where something is left; where much is, from another size of its last cause."""
    if error(problem, fitted.residual).max() < NEARLY:
        return fitted
    done = ended(problem, fitted)
    if error(problem, done.residual).max() < STUCK:
        return done
    return ranked(problem, [done, *_resized(problem, done)])[0]


def _resized(problem: Problem, fitted: Fitted) -> list[Fitted]:
    """Fits from the base values as stated with the last cause larger and smaller: what calibration had bent towards it
    can hold it where it is.
    """
    model, cause = fitted.model, fitted.model.causes[-1]
    first = cause.parameters[0]
    if cause.base is not None or first.name in REACHED:
        return []
    values, ends = model.values(fitted.z, cause), []
    for times in SIZES:
        size = first.value + times * (values[first.name] - first.value)
        size = min(max(size, first.bounds[0]), first.bounds[1])
        z = model.put(model.unbent(fitted.z), cause, values | {first.name: size})
        ends.append(_end(problem, model, z))
    return ends


def ended(problem: Problem, fitted: Fitted) -> Fitted:
    """The better end of the fit gone on with, and of one begun from the base values as stated.

    What calibration bent before the causes were there can stay bent where snatches make the cost rough.
    """
    model = fitted.model
    on, anew = _end(problem, model, fitted.z, fitted.starts), _end(problem, model, model.unbent(fitted.z))
    return ranked(problem, [on, anew])[0]


def _end(problem: Problem, model: Composition, z: Float, starts: Float | None = None) -> Fitted:
    """A long and fine fit from z; states had elsewhere are not carried into it."""
    problem.forget_states()
    return regained(problem, fit(problem, model, z, starts, iterations=LONG, tolerance=FINE))


def regained(problem: Problem, fitted: Fitted) -> Fitted:
    """The fit with its few stray windows started once more from where the instruments put them.

    A start goes its own way while the parameters are still far off, and can stay behind a switch between slack and
    taut: one such window is worth hundreds in chi^2, enough to tell two causes apart that are alike.
    """
    missed = misses(problem, fitted.residual)
    each = missed.max(axis=1)
    astray = np.flatnonzero(each > max(ASTRAY, BEYOND * float(np.median(each))))
    if not 0 < len(astray) <= max(2.0, SHARE * len(each)):
        return fitted
    few, every = problem.part(astray), np.ones(len(fitted.z), bool)
    anew = fit(few, fitted.model, fitted.z, None, iterations=5, fixed=every)
    better = misses(few, anew.residual).sum(axis=1) < 0.9 * missed[astray].sum(axis=1)
    if not better.any():
        return fitted
    starts = fitted.starts.copy()
    starts[astray[better]] = anew.starts[better]
    return ranked(problem, [fit(problem, fitted.model, fitted.z, starts, iterations=4), fitted])[0]


__all__ = ["LONG", "REACHED", "ended", "finished", "regained"]
