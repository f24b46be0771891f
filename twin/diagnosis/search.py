"""Which causes: forward one at a time, backward what a later one made needless, rivals by refit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from twin.causes._kind import Cause
from twin.diagnosis.composition import Composition
from twin.diagnosis.direct import screen
from twin.diagnosis.finish import LONG, REACHED, ended, finished, regained
from twin.diagnosis.fit import Fitted, carried, fit, slopes
from twin.diagnosis.misfit import error, gained, misses, ranked
from twin.diagnosis.normal import Linear
from twin.diagnosis.problem import Problem
from twin.diagnosis.score import Scored, score
from twin.diagnosis.sound import NEEDED, sound
from twin.diagnosis.work import Here, Work

Float = NDArray[np.float64]
Index = NDArray[np.intp]
SHORT_LIST = 7
FINALISTS = 4
QUICK = 3
MOST = 4
NOISE = 1.12
STRONG, LEFT = 0.9, 1.04
#: first-order leaders that are tried before those
ROOM = 3
#: squared error in the sensors' noise, and share of the base's, that two causes leave only where neither is true
HOPELESS, LITTLE = 30.0, 0.03
LARGE = 25.0
DOUBTFUL = 1.4
FEW = 2


@dataclass
class Search:
    """What was tried: current fit, the base fit it began from, scores of the first round, every refit; work: who does
    independent fits; ladder: the fits taken; less: the current one without a cause; sets: fits by the names of their
    causes, taken to their ends where they came near; end: the current fit, once taken to its end.
    """

    problem: Problem
    base: Fitted
    current: Fitted
    work: Work = field(default_factory=Here)
    scores: list[Scored] = field(default_factory=list)
    last_scores: list[Scored] = field(default_factory=list)
    refits: list[Fitted] = field(default_factory=list)
    ladder: list[Fitted] = field(default_factory=list)
    less: dict[tuple[frozenset[str], str], Fitted] = field(default_factory=dict)
    sets: dict[frozenset[str], Fitted] = field(default_factory=dict)
    end: Fitted | None = None

    def end_current(self) -> Fitted:
        """The current fit gone on with to its end, once; the ladder's rung with it."""
        if self.end is not self.current:
            before, self.end = self.current, ended(self.problem, self.current)
            self.current, self.ladder = self.end, [self.end if f is before else f for f in self.ladder]
            self.less.clear()
        return self.current

    def lacking(self, causes: Sequence[Cause]) -> list[Fitted]:
        """The current fit without each of these of its causes; fitted once."""
        current, names = self.current, frozenset(self.current.model.names)
        if len(names) == 1:
            return [self.base for _ in causes]
        new = [c for c in causes if (names, c.name) not in self.less]
        promises = self.work.each(without, self.problem, [(current, c) for c in new])
        self.less |= {(names, c.name): promise() for c, promise in zip(new, promises, strict=True)}
        return [self.less[names, c.name] for c in causes]


def calibrate(problem: Problem, causes: Sequence[Cause] = (), iterations: int = 16) -> Fitted:
    """The base model, or one with causes from null, fitted within the priors."""
    model = Composition(tuple(r.setup for r in problem.runs), tuple(causes))
    z = model.zero()
    settled = fit(problem, model, z, iterations=1, fixed=np.ones(len(z), bool))
    return regained(problem, fit(problem, model, z, settled.starts, iterations=iterations))


def begin(fitted: Fitted, scored: Scored, which: int = 0) -> tuple[Composition, Float]:
    """A model with one more cause, where its best trial says to begin."""
    cause = scored.cause
    model = Composition(fitted.model.setups, (*fitted.model.causes, cause))
    _, amplitude, values = scored.trials[which]
    first = cause.parameters[0]
    start = dict(values)
    if (
        cause.base is None
        and first.name in start
        and first.name not in REACHED
        and cause.name != "force-gauge-resonance"
    ):
        share = amplitude if abs(amplitude) > 0.02 else 0.02
        start[first.name] = first.value + share * (start[first.name] - first.value)
    z = model.put(fitted.model.carry(fitted.z, model), cause, start)
    return model, np.clip(z, model.low, model.high)


def try_causes(
    problem: Problem,
    fitted: Fitted,
    scored: Sequence[Scored],
    direct: Sequence[Scored],
    linear: Linear,
    work: Work,
) -> list[Fitted]:
    """Refits of the most promising causes, best first; those far behind are only begun. linear: `fitted`'s slopes."""
    begun: list[Fitted] = []
    settled: set[str] | None = None
    keep = telling(problem, fitted)
    few, order = problem.part(keep), _interleaved(scored, direct)
    part = replace(fitted, starts=fitted.starts[keep], residual=fitted.residual[keep])
    known = linear.part(keep)
    promises = work.each(_begin_fit, few, [(part, s, None if plain else known) for s, plain in order])
    for (s, plain), promise in zip(order, promises, strict=True):
        if settled is not None and s.cause.name not in settled and (plain or s.gain < 0.5 * scored[0].gain):
            continue
        begun.append(promise())
        if settled is None and error(few, begun[-1].residual).max() < NOISE:
            settled = set(s.cause.rivals)
    begun = [p() for p in work.each(_whole, problem, [(fitted, f, keep) for f in ranked(few, begun)])]
    done = [p() for p in work.each(_long_fit, problem, [(f, None) for f in begun[:1]])]
    others = [f for f in begun[1:FINALISTS] if not _behind(problem, f, done[0])]
    leader = done[0] if others and sound(problem, fitted, done[0]) else None
    done = ranked(problem, [*done, *(p() for p in work.each(_long_fit, problem, [(f, leader) for f in others]))])
    names = {_last(f) for f in done}
    return done + [f for f in begun if _last(f) not in names]


def telling(problem: Problem, fitted: Fitted, share: int = 2) -> Index:
    """Half of the windows (or another share): those that the fit misses most, and others evenly."""
    each = misses(problem, fitted.residual).max(axis=1)
    count = len(each) // share
    worst = np.argsort(-each)[: count // 2]
    rest = np.setdiff1d(np.arange(len(each)), worst)
    chosen = rest[np.unique(np.linspace(0, len(rest) - 1, max(count - len(worst), 1)).round().astype(int))]
    return np.union1d(worst, chosen)


def _whole(problem: Problem, before: Fitted, part: Fitted, keep: Index) -> Fitted:
    """A fit on some windows as one on all: the others' starts are settled by themselves."""
    starts = before.starts.copy()
    starts[keep] = part.starts
    return fit(problem, part.model, part.z, starts, iterations=2, fixed=np.ones(len(part.z), bool))


def _interleaved(scored: Sequence[Scored], direct: Sequence[Scored]) -> list[tuple[Scored, bool]]:
    """First-order and direct leaders in turn, each cause once for each way."""
    order: list[tuple[Scored, bool]] = []
    for place in range(SHORT_LIST):
        order += [(s[place], plain) for s, plain in ((direct, True), (scored, False)) if place < len(s)]
    return order[:10] if direct else order


def _begin_fit(problem: Problem, fitted: Fitted, scored: Scored, known: Linear | None) -> Fitted:
    model, z = begin(fitted, scored)
    if known is not None:
        begun = carried(known, fitted.model, model)
        return fit(problem, model, z, fitted.starts, iterations=QUICK, known=begun)
    if not fitted.model.causes:
        z = model.unbent(z)
    settled = fit(problem, model, z, iterations=1, fixed=np.ones(len(z), bool))
    return fit(problem, model, z, settled.starts, iterations=QUICK + 1)


def _long_fit(problem: Problem, begun: Fitted, leader: Fitted | None) -> Fitted:
    return regained(problem, fit(problem, begun.model, begun.z, begun.starts, iterations=LONG, against=leader))


def _last(fitted: Fitted) -> str:
    return fitted.model.causes[-1].name


def _behind(problem: Problem, fitted: Fitted, best: Fitted) -> bool:
    """Whether a fit, though not finished, can't catch up with one that has reached the noise."""
    mine, its = error(problem, fitted.residual), error(problem, best.residual)
    return bool(its.max() < 1.15 and mine.max() > 12.0)


def forward(search: Search, causes: Sequence[Cause], progress: Callable[[str, float], None]) -> None:
    """Add causes while each lowers the short-window error by more than a little."""
    problem = search.problem
    for turn in range(MOST):
        if turn >= 2 and hopeless(search):
            break
        taken = search.current.model.names
        progress(f"looking for {'a' if not turn else 'a further'} cause", 0.3 + 0.12 * turn)
        left, linear = [c for c in causes if c.name not in taken], slopes(problem, search.current)
        scored = score(problem, search.current, left, linear)
        if not turn:
            search.scores = scored
        search.last_scores = scored
        direct = _direct(problem, search.current, left)
        tried = try_causes(problem, search.current, _offered(search, scored), direct, linear, search.work)
        search.refits += tried
        best = next((f for f in tried if sound(problem, search.current, f)), None)
        if best is None:
            break
        done = finished(problem, best)
        search.current = done if done is best or sound(problem, search.current, done) else best
        search.ladder.append(search.current)


def hopeless(search: Search) -> bool:
    """Whether so much is left, and so little was taken, that no cause of the catalogue can be at the bottom of it."""
    left = float(error(search.problem, search.current.residual).max())
    return left > max(HOPELESS, LITTLE * float(error(search.problem, search.base.residual).max()))


def _offered(search: Search, scored: Sequence[Scored]) -> list[Scored]:
    """Causes that first order speaks for; while something is left, besides, those that alone explained nearly all of a
    channel: what was taken in their stead may have bent until nothing of them shows to first order.
    """
    offered = [s for s in scored if s.gain > 15.0]
    if not search.refits or error(search.problem, search.current.residual).max() < LEFT:
        return offered
    alone = [f for f in search.refits if len(f.model.causes) == 1]
    strong = {_last(f) for f in alone if gained(search.problem, search.base, f) > STRONG}
    again = [s for s in scored if s.cause.name in strong and s not in offered[:ROOM]][:2]
    kept = [s for s in offered if s not in again]
    return kept[:ROOM] + again + kept[ROOM:]


def _direct(problem: Problem, fitted: Fitted, causes: Sequence[Cause]) -> list[Scored]:
    """The direct screen where something large is wrong: on the windows that miss most and on others, evenly."""
    each = misses(problem, fitted.residual).max(axis=1)
    if error(problem, fitted.residual).max() < DOUBTFUL and np.sum(each > LARGE) < FEW:
        return []
    few = problem.part(telling(problem, fitted, 3))
    z = fitted.z if fitted.model.causes else fitted.model.zero()
    return screen(few, fitted.model, z, causes)[:SHORT_LIST]


def backward(search: Search) -> None:
    """Take back what a later cause made needless."""
    problem = search.problem
    while len(search.current.model.causes) > 1:
        best = ranked(problem, search.lacking(search.current.model.causes))[0]
        search.refits.append(best)
        if gained(problem, best, search.current) >= NEEDED:
            break
        search.current = best


def without(problem: Problem, fitted: Fitted, cause: Cause, iterations: int = 5) -> Fitted:
    """The fit without one of its causes."""
    model = Composition(fitted.model.setups, tuple(c for c in fitted.model.causes if c.name != cause.name))
    z = np.clip(fitted.model.carry(fitted.z, model), model.low, model.high)
    return regained(problem, fit(problem, model, z, fitted.starts, iterations=iterations))
