"""Which causes: forward one at a time, backward what a later one made needless, rivals by refit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from twin.causes._kind import Cause
from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import Fitted, fit, loss, scale
from twin.diagnosis.problem import Problem
from twin.diagnosis.score import Scored, score

Float = NDArray[np.float64]
SHORT_LIST = 7
FINALISTS = 3
MOST = 4
NEEDED = 0.012
NOISE = 1.12


@dataclass
class Search:
    """What was tried: current fit, the base fit it began from, scores of the first round, and every refit."""

    problem: Problem
    base: Fitted
    current: Fitted
    scores: list[Scored] = field(default_factory=list)
    last_scores: list[Scored] = field(default_factory=list)
    refits: list[Fitted] = field(default_factory=list)
    ladder: list[Fitted] = field(default_factory=list)


def error(problem: Problem, left: Float) -> Float:
    """Squared short-window error in the sensors' noise, per channel [2]: the mean over windows, the wildest tenth capped."""
    squares = (left / problem.sigma[:, None, :]) ** 2
    use = problem.windows.use
    each = squares.sum(axis=1) / np.maximum(use.sum(axis=1), 1)
    cap = np.percentile(each, 90, axis=0)
    mean: Float = np.minimum(each, cap).mean(axis=0)
    return mean


def gained(problem: Problem, before: Fitted, after: Fitted) -> float:
    """The share by which the squared short-window error falls, in the channel where it falls most."""
    old, new = error(problem, before.residual), error(problem, after.residual)
    return float(np.max((old - new) / np.maximum(old, 1e-12)))


def calibrate(problem: Problem, causes: Sequence[Cause] = (), iterations: int = 6) -> Fitted:
    """The base model, or one with causes from null, fitted within the priors."""
    model = Composition(tuple(r.setup for r in problem.runs), tuple(causes))
    z = model.zero()
    settled = fit(problem, model, z, iterations=1, fixed=np.ones(len(z), bool))
    return fit(problem, model, z, settled.starts, iterations=iterations)


def begin(fitted: Fitted, scored: Scored, which: int = 0) -> tuple[Composition, Float]:
    """A model with one more cause, where its best trial says to begin."""
    cause = scored.cause
    model = Composition(fitted.model.setups, (*fitted.model.causes, cause))
    _, amplitude, values = scored.trials[which]
    first = cause.parameters[0]
    start = dict(values)
    if cause.base is None and first.name in start:
        share = amplitude if abs(amplitude) > 0.02 else 0.02
        start[first.name] = first.value + share * (start[first.name] - first.value)
    z = model.put(fitted.model.carry(fitted.z, model), cause, start)
    low = np.array([c.low for c in model.coordinates])
    high = np.array([c.high for c in model.coordinates])
    return model, np.clip(z, low, high)


def try_causes(
    problem: Problem, fitted: Fitted, scored: Sequence[Scored], quick: int = 3, long: int = 12
) -> list[Fitted]:
    """Refits of the most promising causes, best first; those far behind are only begun."""
    begun: list[Fitted] = []
    settled: set[str] | None = None
    for s in scored[:SHORT_LIST]:
        if settled is not None and s.cause.name not in settled and s.gain < 0.5 * scored[0].gain:
            continue
        model, z = begin(fitted, s)
        begun.append(fit(problem, model, z, fitted.starts, iterations=quick))
        if settled is None and error(problem, begun[-1].residual).max() < NOISE:
            settled = set(s.cause.rivals)
    begun = ranked(problem, begun)
    done: list[Fitted] = []
    for f in begun[:FINALISTS]:
        if done and _behind(problem, f, done[0]):
            continue
        done = ranked(problem, [*done, fit(problem, f.model, f.z, f.starts, iterations=long)])
    names = {_last(f) for f in done}
    return done + [f for f in begun if _last(f) not in names]


def _last(fitted: Fitted) -> str:
    return fitted.model.causes[-1].name


def _behind(problem: Problem, fitted: Fitted, best: Fitted) -> bool:
    """Whether a fit, though not finished, can't catch up with one that has reached the noise."""
    mine, its = error(problem, fitted.residual), error(problem, best.residual)
    return bool(its.max() < 1.15 and mine.max() > 12.0)


def ranked(problem: Problem, fits: Sequence[Fitted]) -> list[Fitted]:
    """Best first, all on the scale of the one that leaves least."""
    if not fits:
        return []
    spread = np.min([scale(problem, f.residual) for f in fits], axis=0)
    return sorted(fits, key=lambda f: loss(f.residual, spread) + _price(f))


def _price(fitted: Fitted) -> float:
    """What priors and the number of parameters cost."""
    priors = np.array([c.prior for c in fitted.model.coordinates])
    free = sum(len(c.parameters) for c in fitted.model.causes)
    return float(np.sum((fitted.z / priors) ** 2)) + 8.0 * free


def forward(problem: Problem, base: Fitted, causes: Sequence[Cause], progress: Callable[[str, float], None]) -> Search:
    """Add causes while each lowers the short-window error by more than a little."""
    search = Search(problem, base, base, ladder=[base])
    for turn in range(MOST):
        taken = {c.name for c in search.current.model.causes}
        progress(f"looking for {'a' if not turn else 'a further'} cause", 0.3 + 0.12 * turn)
        scored = score(problem, search.current, [c for c in causes if c.name not in taken])
        if not turn:
            search.scores = scored
        search.last_scores = scored
        tried = try_causes(problem, search.current, [s for s in scored if s.gain > 15.0])
        search.refits += tried
        if not tried or gained(problem, search.current, tried[0]) < NEEDED:
            break
        search.current = tried[0]
        search.ladder.append(tried[0])
    return search


def backward(search: Search) -> None:
    """Take back what a later cause made needless."""
    problem = search.problem
    while len(search.current.model.causes) > 1:
        thinner = [without(problem, search.current, c) for c in search.current.model.causes]
        best = ranked(problem, thinner)[0]
        search.refits.append(best)
        if gained(problem, best, search.current) >= NEEDED:
            break
        search.current = best


def without(problem: Problem, fitted: Fitted, cause: Cause, iterations: int = 5) -> Fitted:
    """The fit without one of its causes."""
    model = Composition(fitted.model.setups, tuple(c for c in fitted.model.causes if c.name != cause.name))
    z = fitted.model.carry(fitted.z, model)
    low = np.array([c.low for c in model.coordinates])
    high = np.array([c.high for c in model.coordinates])
    return fit(problem, model, np.clip(z, low, high), fitted.starts, iterations=iterations)
