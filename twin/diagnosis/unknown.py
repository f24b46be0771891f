"""When structure remains beyond the catalogue: the latent term that explains it, refitted and judged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import Fitted, fit, loss, scale, weigh
from twin.diagnosis.latent import POSITIONS, PRICE, Term, as_cause, terms
from twin.diagnosis.misfit import error, misses, prior_price
from twin.diagnosis.problem import Problem
from twin.diagnosis.search import Search

ENOUGH = 1.10
SHARE = 0.10
#: squared error that a learned term may leave, and share of its promise at which one of another kind is tried
RIGHT, PROMISING = 2.0, 0.3
#: where nothing is named and such a share of the windows misses by so much, in the noise squared, a term is told that
#: takes so little of it
OFTEN, WRONG, LITTLE = 0.25, 3.0, 0.01
ALIKE = 0.8
SPEEDS = ("weight_velocity", "drive_velocity")


@dataclass(frozen=True)
class Unknown:
    """The term, what it may depend on (ranked), the fit with it, and the share of the squared error that it takes."""

    term: Term
    depends_on: tuple[str, ...]
    fitted: Fitted
    gain: float
    learned: bool


def look(search: Search) -> Unknown | None:
    """The latent term, or None where the catalogue's model leaves hardly more than noise."""
    problem, final = search.problem, search.current
    if error(problem, final.residual, wild=0.0).max() < ENOUGH:  # a single wild window is no structure
        return None
    wrong = np.mean(misses(problem, final.residual).max(axis=1) > WRONG)
    least = LITTLE if not final.model.causes and wrong > OFTEN else SHARE
    candidates = [c for c in (_best(problem, f, least) for f in _beginnings(search)) if c is not None]
    if not candidates:
        return None
    return _choose(search, candidates)


def _beginnings(search: Search) -> list[Fitted]:
    """The calibrated base, and the catalogue's best."""
    return [search.current] if not search.current.model.causes else [search.base, search.current]


def _best(problem: Problem, fitted: Fitted, least: float) -> Unknown | None:
    found = terms(problem, fitted)
    spread = scale(problem, fitted.residual)
    weighted = float(np.sum((fitted.residual / spread) ** 2 * weigh(fitted.residual, spread)))
    if not found or found[0].gain < least * weighted:
        return None
    found, refit = _learned(problem, fitted, found)
    term = found[0]
    alike = [t.variable for t in found if t.gain > ALIKE * term.gain]
    names = tuple(dict.fromkeys([term.variable, *_aliases(term.variable), *alike]))[:4]
    before = float(error(problem, fitted.residual).max())
    if refit is not None and (after := float(error(problem, refit.residual).max())) < 0.8 * before:
        return Unknown(term, names, refit, 1.0 - after / before, True)
    return Unknown(term, names, fitted, term.gain / weighted, False)


def _learned(problem: Problem, fitted: Fitted, found: list[Term]) -> tuple[list[Term], Fitted | None]:
    """The terms, the best learned one first, and its refit. What promises most to first order may do so by its many
    knots: where its refit leaves much, the best of another kind of variable is tried, too.
    """
    refit = refitted(problem, fitted, found[0])
    if refit is None or error(problem, refit.residual).max() < RIGHT:
        return found, refit
    others = [t for t in found if t.variable not in _kind(found[0].variable)]
    if not others or others[0].gain < PROMISING * found[0].gain:
        return found, refit
    second = refitted(problem, fitted, others[0])
    if second is None or error(problem, second.residual).max() > ALIKE * error(problem, refit.residual).max():
        return found, refit
    return others, second


def _kind(variable: str) -> tuple[str, ...]:
    """A variable and what data can't tell from it, taut: the same motion on both sides of the pulley and at its rim."""
    return next((alike for alike in (POSITIONS, SPEEDS) if variable in alike), (variable,))


def _aliases(variable: str) -> list[str]:
    return ["time"] if variable == "frequency" else [name for name in _kind(variable) if name != variable]


def refitted(problem: Problem, fitted: Fitted, term: Term) -> Fitted | None:
    """The term put in as a table and refitted with all else."""
    cause = as_cause(term)
    if cause is None:
        return None
    model = Composition(fitted.model.setups, (*fitted.model.causes, cause))
    z = fitted.model.carry(fitted.z, model)
    z = model.put(z, cause, {f"y{i}": float(y) for i, y in enumerate(term.y)})
    return fit(problem, model, z, fitted.starts, iterations=7)


def _left(problem: Problem, unknown: Unknown) -> float:
    """The squared error with the term: as refitted, or to first order."""
    left = float(error(problem, unknown.fitted.residual).max())
    return left if unknown.learned else left * (1.0 - unknown.gain)


def _choose(search: Search, candidates: list[Unknown]) -> Unknown | None:
    """The base with a term where that does as well as the catalogue's causes; else a term beside them, if worth it."""
    problem = search.problem
    catalogue = float(error(problem, search.current.residual).max())
    alone = [c for c in candidates if set(c.fitted.model.names) <= {"unknown"}]
    beside = [c for c in candidates if c not in alone]
    if alone and (not search.current.model.causes or _better(problem, alone[0], search.current)):
        return alone[0]
    if beside and 1.0 - _left(problem, beside[0]) / catalogue > SHARE:
        return beside[0]
    return None


def _better(problem: Problem, alone: Unknown, catalogue: Fitted) -> bool:
    """Whether the base with a learned term explains more than the catalogue's causes, each knot at its price."""
    if not alone.learned:
        return False
    spread = np.minimum(scale(problem, alone.fitted.residual), scale(problem, catalogue.residual))
    price = PRICE * len(alone.term.x)
    mine = loss(alone.fitted.residual, spread) + price
    return mine < loss(catalogue.residual, spread) + prior_price(catalogue)


__all__ = ["Unknown", "look", "refitted"]
