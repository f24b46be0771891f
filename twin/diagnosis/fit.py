"""Gauss-Newton over windows: global coordinates and every window's start together, robustly."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.diagnosis.composition import Composition
from twin.diagnosis.coordinates import STATED
from twin.diagnosis.normal import Linear, Reduced, reduce, solve
from twin.diagnosis.problem import Problem

Float = NDArray[np.float64]
#: which coordinates may move, and how far in one step
Within = tuple[NDArray[np.bool_], float]
TAIL = 4.0
FLOOR = 0.4
#: forward steps of a coordinate and of a start: a window that snatches jumps at places, and a longer step crosses more
#: of them (0.02 crossed some in 2 windows of 150, which then outweighed all others); a shorter one sees the stepper's
#: own tolerance
STEP, START_STEP = 0.001, 0.01
FAR = 8.0
BASE_EVERY, BEGIN_EVERY = 4, 2
#: heights of a learned term beyond which their columns are differenced as seldom as base values'
MANY = 30
#: relative gain in cost at which a fit ends that something hangs on: about one in chi^2
FINE = 1e-5
#: of chi^2 for each sample by which a fit may be behind another for the two to be near, and how many times the pace of
#: the better of its last two steps a fit that chases another is trusted to keep up
NEAR, PACE = 0.03, 2.0


@dataclass(frozen=True)
class Fitted:
    """Where a fit stands: z, starts [w, 4] (in spreads), residual [w, LENGTH, 2] (data - prediction, 0 where unused),
    cost: robust, in the scale it was asked for.
    given_up: not finished, for it could not come near the fit that it was held against."""

    model: Composition
    z: Float
    starts: Float
    residual: Float
    cost: float
    given_up: bool = False


def residual(problem: Problem, model: Composition, z: Float, starts: Float) -> Float:
    """Data minus prediction, zero where a sample doesn't count; 3e3 sigma at most."""
    left = problem.data - problem.predict(model, z, starts)
    limit = 3e3 * problem.sigma[:, None, :]
    left = np.where(np.isfinite(left), np.clip(left, -limit, limit), limit)
    left[~problem.windows.use] = 0.0
    return left


def scale(problem: Problem, left: Float) -> Float:
    """One sigma of each sample's channel, [w, 1, 2]: the sensor's and a floor of what the model can't do yet."""
    use = problem.windows.use
    floor = [
        FLOOR * float(np.median(np.abs(left[..., c][use[..., c]]))) if use[..., c].any() else 0.0 for c in range(2)
    ]
    spread: Float = np.sqrt(problem.sigma**2 + np.square(floor))[:, None, :]
    return spread


def weigh(left: Float, spread: Float) -> Float:
    """Student-t weights."""
    return (TAIL + 1) / (TAIL + (left / spread) ** 2)


def loss(left: Float, spread: Float) -> float:
    """Student-t loss; about chi^2 while residuals are small."""
    return float(np.sum((TAIL + 1) * np.log1p((left / spread) ** 2 / TAIL)))


def prior_cost(model: Composition, z: Float, starts: Float) -> float:
    """What priors of coordinates and starts cost."""
    sigma = np.array([c.prior for c in model.coordinates])
    return float(np.sum((z / sigma) ** 2) + np.sum(starts**2))


def linearise(
    problem: Problem,
    fitted: Fitted,
    spread: Float,
    free: NDArray[np.bool_],
    known: Linear | None = None,
    *,
    base: bool = True,
    begin: bool = True,
    step: float = STEP,
) -> Linear:
    """Differences over `step`, forward or backward, in every free coordinate, and forward ones in the starts.

    From `known`, an earlier linearisation of the same model, base values' columns, and those of a learned term's many
    heights, stay unless `base` asks for new ones, the starts' unless `begin` does; the causes' are always new.
    """
    model, z, starts = fitted.model, fitted.z, fitted.starts
    root = np.sqrt(weigh(fitted.residual, spread)) / spread * problem.windows.use
    here = problem.predict(model, z, starts)
    flat = len(problem.windows), -1
    again = np.ones(1) if known is None else np.nan_to_num(root.reshape(flat) / known.root)

    def column(there: Float, step: float) -> Float:
        slope: Float = np.clip((there - here) / step, -1e9, 1e9) * root
        return np.nan_to_num(slope).reshape(flat)

    if known is None or begin:
        own = np.array([column(problem.predict(model, z, _moved(starts, a)), START_STEP) for a in range(4)])
    else:
        own = known.starts * again
    renew = free if known is None or base else free & _quick(model)
    columns = _globals(problem, fitted, renew, column, step)
    if known is not None:
        kept = free & ~renew
        columns[kept] = known.columns[kept] * again
    weighted = (fitted.residual * root).reshape(flat)
    prior = np.array([1.0 / c.prior**2 for c in model.coordinates])
    return Linear(columns, own, weighted, prior, np.maximum(root.reshape(flat), 1e-30))


def _quick(model: Composition) -> NDArray[np.bool_]:
    """The coordinates whose columns change from step to step."""
    owners = [c.owner for c in model.coordinates]
    slow = (*STATED, "unknown") if owners.count("unknown") > MANY else STATED
    return np.array([owner not in slow for owner in owners])


def slopes(problem: Problem, fitted: Fitted, known: Linear | None = None, step: float = STEP) -> Linear:
    """Every column, anew, where a fit stands and on its own scale; with `known`, the starts' columns from there."""
    every = np.ones(len(fitted.z), bool)
    return linearise(problem, fitted, scale(problem, fitted.residual), every, known, begin=known is None, step=step)


def _moved(starts: Float, axis: int) -> Float:
    moved = starts.copy()
    moved[:, axis] += START_STEP
    return moved


def carried(linear: Linear, before: Composition, model: Composition) -> Linear:
    """A linearisation as one of another model; columns that the first has not are 0."""
    place = {(c.owner, c.name, c.run): i for i, c in enumerate(before.coordinates)}
    columns = np.zeros((len(model.coordinates), *linear.residual.shape))
    for i, c in enumerate(model.coordinates):
        if (c.owner, c.name, c.run) in place:
            columns[i] = linear.columns[place[c.owner, c.name, c.run]]
    prior = np.array([1.0 / c.prior**2 for c in model.coordinates])
    return Linear(columns, linear.starts, linear.residual, prior, linear.root)


def _globals(
    problem: Problem, fitted: Fitted, free: NDArray[np.bool_], column: Callable[[Float, float], Float], span: float
) -> Float:
    model, z, starts = fitted.model, fitted.z, fitted.starts
    flat = len(problem.windows), problem.data.shape[1] * 2
    columns = np.zeros((len(z), *flat))
    ofruns = [i for i, c in enumerate(model.coordinates) if c.run >= 0]
    for i, c in enumerate(model.coordinates):
        if c.run >= 0 or not free[i]:
            continue
        step = span if c.low <= z[i] + span <= c.high else -span
        moved = z.copy()
        moved[i] += step
        columns[i] = column(problem.predict(model, moved, starts), step)
    if ofruns and free[ofruns].any():
        moved = z.copy()
        moved[ofruns] += span * 5
        every = column(problem.predict(model, moved, starts), span * 5)
        for i in ofruns:
            mine = problem.windows.run == model.coordinates[i].run
            columns[i, mine] = every[mine]
    return columns


def fit(
    problem: Problem,
    model: Composition,
    z: Float,
    starts: Float | None = None,
    *,
    iterations: int = 8,
    fixed: NDArray[np.bool_] | None = None,
    tolerance: float = 2e-4,
    reach: float = 12.0,
    known: Linear | None = None,
    against: Fitted | None = None,
) -> Fitted:
    """Minimise the robust cost from z and starts; `fixed` coordinates stay. known: a linearisation there, if there is
    one; against: a fit of the same windows, and this one is given up where at its pace it can't come near that.

    What changes slowly is differenced anew every few turns only, and where a step fails or hardly gains.
    """
    starts = np.zeros((len(problem.windows), 4)) if starts is None else starts
    free = np.ones(len(z), bool) if fixed is None else ~fixed
    left = residual(problem, model, z, starts)
    fitted = Fitted(model, z, starts, left, 0.0)
    damping, linear = 1e-6, known
    age, anew, given_up = 0, False, False
    gaps = [] if against is None else [shortfall(problem, fitted, against)]
    for turn in range(iterations):
        given_up = _lost(gaps, iterations - turn)
        if given_up:
            break
        spread = scale(problem, fitted.residual)
        cost = loss(fitted.residual, spread) + prior_cost(model, fitted.z, fitted.starts)
        anew = anew or linear is None or age >= BASE_EVERY
        begin = anew or (age % BEGIN_EVERY == 0 and age > 0)
        age = 1 if anew else age + 1
        linear = linearise(problem, fitted, spread, free, linear, base=anew, begin=begin)
        reduced = reduce(linear, fitted.starts, fitted.z)
        better, damping = _descend(problem, fitted, reduced, spread, cost, (free, reach), damping)
        if better is None:
            if anew:
                break
            anew = True
            continue
        gained = (cost - better.cost) / max(cost, 1e-9)
        fitted = better
        if against is not None:
            gaps.append(shortfall(problem, fitted, against))
        if gained < tolerance and (anew or gained < 0.1 * tolerance):
            break
        anew = gained < tolerance
    return replace(fitted, given_up=given_up)


def shortfall(problem: Problem, fitted: Fitted, other: Fitted) -> float:
    """How much more a fit leaves than another, beyond what two may differ by that are near one another: in the robust
    loss, for a window astray is no difference.
    """
    spread = np.minimum(scale(problem, fitted.residual), scale(problem, other.residual))
    more = loss(fitted.residual, spread) - loss(other.residual, spread)
    return float(more - NEAR * np.count_nonzero(problem.windows.use))


def _lost(gaps: Sequence[float], left: int) -> bool:
    """Whether what was behind by so much after each step stays behind for all the turns that are left."""
    if len(gaps) < 4:
        return False
    pace = max(gaps[-3] - gaps[-2], gaps[-2] - gaps[-1], 0.0)
    return bool(gaps[-1] > PACE * pace * left)


def _descend(
    problem: Problem, fitted: Fitted, reduced: Reduced, spread: Float, cost: float, within: Within, damping: float
) -> tuple[Fitted | None, float]:
    """A step that lowers the cost, as little damped as does, and the damping to go on with; None where none does."""
    (free, reach), low, high = within, fitted.model.low, fitted.model.high
    for _ in range(4):
        step = np.clip(solve(reduced, fitted.z, low, high, free, damping), -reach, reach)
        z = np.clip(fitted.z + step, low, high)
        starts = np.clip(fitted.starts + reduced.follow(z - fitted.z), -FAR, FAR)
        left = residual(problem, fitted.model, z, starts)
        new = loss(left, spread) + prior_cost(fitted.model, z, starts)
        if new < cost:
            return replace(fitted, z=z, starts=starts, residual=left, cost=new), max(damping / 30, 1e-8)
        damping *= 100
    return None, damping
