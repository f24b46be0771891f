"""Rivals by refit: which other causes explain the windows as well, and how probable each is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from twin.causes._kind import Cause
from twin.diagnosis.finish import ended, regained
from twin.diagnosis.fit import Fitted, fit, loss, scale, shortfall, slopes
from twin.diagnosis.found import Rival
from twin.diagnosis.misfit import error, gained, prior_price
from twin.diagnosis.problem import Problem
from twin.diagnosis.score import Scored, score
from twin.diagnosis.search import Search, backward, begin, hopeless, without
from twin.diagnosis.sound import NEEDED

Float = NDArray[np.float64]
TEMPER = 8.0
#: trust in a cause beyond its rivals: at best, where nothing is left but noise; and how much it counts that something
#: is: a cause that lowers the squared error by HALF times what it leaves is as likely wrong as right
BEST, HALF, NOTHING = 0.98, 0.7, 0.02
#: of what is left, the difference in squared error that tells nothing
SHARE = 0.03
ALIKE = 40.0
MOST = 4
SWAPS = 3
CLEARLY = 30.0
#: iterations of a rival's refit, from its first-order trial and from an earlier refit of the same causes
ANEW, AGAIN = 10, 6


@dataclass(frozen=True)
class Standing:
    """A cause among its rivals: loss beyond the best's by name, probability, who can't be told from it, the rivals'
    fits in its place, and their odds against it.
    """

    name: str
    behind: Mapping[str, float]
    probability: float
    alike: tuple[str, ...]
    fits: Mapping[str, Fitted]
    odds: Mapping[str, float] = field(default_factory=dict)


def standings(search: Search, catalogue: Sequence[Cause]) -> list[Standing]:
    """Each found cause against its rivals, refitted in its place."""
    causes = search.current.model.causes
    search.lacking(causes)
    fits = [_rivals(search, cause, catalogue) for cause in causes]
    if any(_near(search.problem, search.current, f) for each in fits for f in each.values()):
        search.end_current()
        search.lacking(causes)
    return [_standing(search, cause, each) for cause, each in zip(causes, fits, strict=True)]


def settle(search: Search, catalogue: Sequence[Cause]) -> list[Standing]:
    """Standings once no rival does better in a cause's place: one that does takes it, and what that makes needless
    goes. Where nearly everything is left, rivals are not worth their refits.
    """
    if len(search.current.model.causes) > 1 and hopeless(search):
        return [Standing(c.name, {}, trust(search, c), (), {}) for c in search.current.model.causes]
    for _ in range(SWAPS):
        ranks = standings(search, catalogue)
        better = [(d, r.fits[n]) for r in ranks for n, d in r.behind.items() if d < -CLEARLY]
        chosen = min(better, key=lambda pair: pair[0])[1] if better else None
        chosen = chosen or _merged(search, ranks)
        if chosen is None:
            return ranks
        search.sets[frozenset(search.current.model.names)] = search.current
        search.current = chosen
        search.ladder.append(search.current)
        backward(search)
    return standings(search, catalogue)


def _merged(search: Search, ranks: Sequence[Standing]) -> Fitted | None:
    """A rival that does as well in a cause's place and makes another cause needless."""
    problem = search.problem
    for rank in ranks:
        for name in rank.alike[:2]:
            model = rank.fits[name].model
            for cause in model.causes:
                if len(model.causes) < 2 or cause.name == name:
                    continue
                thinner = without(problem, rank.fits[name], cause)
                if gained(problem, thinner, search.current) < NEEDED:
                    return thinner
    return None


def _rivals(search: Search, cause: Cause, catalogue: Sequence[Cause]) -> dict[str, Fitted]:
    """The fits with each rival in a cause's place; those of a set of causes that was there before stay as they are."""
    rivals = _candidates(search, cause, catalogue)
    sets = {r.name: _instead_of(search, cause, r) for r in rivals}
    new = [r for r in rivals if sets[r.name] not in search.sets]
    jobs = [(search.current, *begun) for begun in _begun(search, cause, new)]
    promises = search.work.each(_instead, search.problem, jobs)
    search.sets |= {sets[r.name]: promise() for r, promise in zip(new, promises, strict=True)}
    return {name: search.sets[key] for name, key in sets.items()}


def _instead_of(search: Search, cause: Cause, rival: Cause) -> frozenset[str]:
    """The names of the model's causes with the rival in the cause's place."""
    return frozenset(search.current.model.names) - {cause.name} | {rival.name}


def _standing(search: Search, cause: Cause, fits: Mapping[str, Fitted]) -> Standing:
    problem, final = search.problem, search.current
    spread = scale(problem, final.residual)
    here = loss(final.residual, spread) + prior_price(final)
    behind = {n: loss(f.residual, spread) + prior_price(f) - here for n, f in fits.items()}
    after = error(problem, final.residual)
    misfit = {n: float(np.max((error(problem, f.residual) - after) / _left(after))) for n, f in fits.items()}
    odds = {n: _odds(d, misfit[n]) for n, d in behind.items()}
    alike = tuple(sorted((n for n, d in behind.items() if d < ALIKE or misfit[n] < SHARE), key=lambda n: behind[n]))
    return Standing(cause.name, behind, trust(search, cause) / (1.0 + sum(odds.values())), alike, fits, odds)


def trust(search: Search, cause: Cause) -> float:
    """How far a cause is to be believed, its rivals apart: what it takes away against what is left beside it."""
    before = error(search.problem, search.lacking([cause])[0].residual)
    after = error(search.problem, search.current.residual)
    taken = float(np.max(before - after))
    return BEST * max(taken, 0.0) / (max(taken, 0.0) + HALF * float(_left(after).max()))


def _left(after: Float) -> Float:
    """What is left of the squared error beyond the noise, per channel."""
    left: Float = np.maximum(after - 1.0, NOTHING)
    return left


def _odds(behind: float, misfit: float) -> float:
    """A rival's against the cause in whose place it stands: by the loss, and by how little it misses more than what
    both leave unexplained.
    """
    return float(max(np.exp(-max(behind, 0.0) / (2 * TEMPER)), np.exp(-max(misfit, 0.0) / SHARE)))


def _candidates(search: Search, cause: Cause, catalogue: Sequence[Cause]) -> list[Cause]:
    """Declared rivals, and those whose refit in the same place came near."""
    named = search.current.model.names
    final = float(error(search.problem, search.current.residual).max())
    near: dict[str, float] = {}
    for f in search.refits:
        causes = f.model.names
        if causes and causes[-1] not in named:
            left = float(error(search.problem, f.residual).max())
            if left < 4.0 * final + 2.0:
                near[causes[-1]] = min(left, near.get(causes[-1], np.inf))
    order = list(dict.fromkeys([*sorted(near, key=lambda n: near[n])[:2], *cause.rivals]))
    known = {c.name: c for c in catalogue}
    return [known[n] for n in order if n in known and n not in named][:MOST]


def _begun(search: Search, cause: Cause, rivals: Sequence[Cause]) -> list[tuple[Fitted, int]]:
    """Where each rival's refit in the cause's place begins, and its iterations: from an earlier refit of just those
    causes, or from its best trial on the model without the cause; 0 where no trial shows anything.
    """
    problem = search.problem
    earlier = {frozenset(f.model.names): f for f in reversed(search.refits)}
    before = {r.name: earlier.get(_instead_of(search, cause, r)) for r in rivals}
    new = [r for r in rivals if before[r.name] is None]
    anew: dict[str, tuple[Fitted, int]] = {}
    if new:
        less = _less(search, cause)
        for scored in search.work.each(_scored, problem, [(less, new)])[0]():
            anew[scored.cause.name] = less, 0
            if scored.trials:
                model, z = begin(less, scored)
                anew[scored.cause.name] = replace(less, model=model, z=z), ANEW
    known = {n: (f, ANEW if f.given_up else AGAIN) for n, f in before.items() if f is not None}
    return [(known | anew)[r.name] for r in rivals]


def _less(search: Search, cause: Cause) -> Fitted:
    """The model without the cause; where that is the base, not as far bent to make up for it as calibration did."""
    if len(search.current.model.causes) > 1:
        return search.lacking([cause])[0]
    return search.work.each(without, search.problem, [(search.current, cause, 3)])[0]()


def _scored(problem: Problem, less: Fitted, rivals: Sequence[Cause]) -> list[Scored]:
    return score(problem, less, rivals, slopes(problem, less))


def _instead(problem: Problem, final: Fitted, begun: Fitted, iterations: int) -> Fitted:
    """A rival's refit in a cause's place."""
    if not iterations:
        return begun
    fitted = fit(problem, begun.model, begun.z, begun.starts, iterations=iterations, against=final)
    return _matched(problem, final, fitted)


def _matched(problem: Problem, final: Fitted, rival: Fitted) -> Fitted:
    """A rival that comes near is taken to its end as the final model was: hundreds in chi^2 can be left in between."""
    rival = regained(problem, rival)
    return ended(problem, rival) if _near(problem, final, rival) else rival


def _near(problem: Problem, final: Fitted, rival: Fitted) -> bool:
    """Whether a rival leaves hardly more."""
    return shortfall(problem, rival, final) < 0.0


def tried(search: Search, ranks: Sequence[Standing]) -> tuple[Rival, ...]:
    """Every cause set that was refitted in a found cause's place, most probable first, for the page."""
    told = []
    for rank in ranks:
        for name, odds in rank.odds.items():
            told.append(_rival(search, rank.fits[name], rank.probability * odds))
    return tuple(sorted(told, key=lambda r: -r.probability))


def _rival(search: Search, fitted: Fitted, probability: float) -> Rival:
    u, F = np.sqrt(error(search.problem, fitted.residual))
    values = {c.name: fitted.model.values(fitted.z, c) for c in fitted.model.causes}
    return Rival(tuple(values), (float(u), float(F)), probability, values)


__all__ = ["Standing", "settle", "tried"]
