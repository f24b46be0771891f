"""When structure remains beyond the catalogue: the latent term that explains it, refitted and judged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import Fitted, fit, scale
from twin.diagnosis.latent import Term, as_cause, terms
from twin.diagnosis.problem import Problem
from twin.diagnosis.search import Search, error, without

ENOUGH = 1.10
SHARE = 0.10
ALIKE = 0.8


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
    left = error(problem, final.residual)
    if left.max() < ENOUGH:
        return None
    candidates = [c for c in (_best(problem, f) for f in _beginnings(search)) if c is not None]
    if not candidates:
        return None
    return _choose(search, candidates)


def _beginnings(search: Search) -> list[Fitted]:
    """The calibrated base, and the catalogue's best."""
    return [search.current] if not search.current.model.causes else [search.base, search.current]


def _best(problem: Problem, fitted: Fitted) -> Unknown | None:
    found = terms(problem, fitted)
    spread = scale(problem, fitted.residual)
    weighted = float(np.sum((fitted.residual / spread) ** 2))
    if not found or found[0].gain < 0.04 * weighted:
        return None
    best = _refitted(problem, fitted, found[:3])
    if best is None:
        return None
    term, refit, learned = best
    alike = [t.variable for t in found if t.gain > ALIKE * term.gain]
    names = tuple(dict.fromkeys([term.variable, *_aliases(term.variable), *alike]))
    before, after = error(problem, fitted.residual).max(), error(problem, refit.residual).max()
    return Unknown(term, names[:3], refit, float(1.0 - after / before) if learned else term.gain / weighted, learned)


def _aliases(variable: str) -> list[str]:
    """What data can't tell apart, taut: the same motion on both sides of the pulley."""
    return {
        "weight_position": ["drive_position"], "pulley_angle": ["drive_position"], "drive_position": ["weight_position"],
        "weight_velocity": ["drive_velocity"], "drive_velocity": ["weight_velocity"], "frequency": ["time"],
    }.get(variable, [])  # fmt: skip


def _refitted(problem: Problem, fitted: Fitted, found: list[Term]) -> tuple[Term, Fitted, bool] | None:
    """The first terms put in as tables and refitted; the one that leaves least."""
    done: list[tuple[float, Term, Fitted, bool]] = []
    for term in found:
        cause = as_cause(term)
        if cause is None:
            done.append((float(error(problem, fitted.residual).max()) - 1e-9, term, fitted, False))
            continue
        model = Composition(fitted.model.setups, (*fitted.model.causes, cause))
        z = fitted.model.carry(fitted.z, model)
        z = model.put(z, cause, {f"y{i}": float(y) for i, y in enumerate(term.y)})
        refit = fit(problem, model, z, fitted.starts, iterations=4)
        done.append((float(error(problem, refit.residual).max()), term, refit, True))
    if found[0].frequency is not None:
        return found[0], fitted, False
    best = min(done, key=lambda d: d[0])
    return best[1], best[2], best[3]


def _choose(search: Search, candidates: list[Unknown]) -> Unknown | None:
    """The base with a term where that does as well as the catalogue's causes; else a term beside them, if worth it."""
    problem = search.problem
    catalogue = float(error(problem, search.current.residual).max())
    first = candidates[0]
    alone = not first.fitted.model.causes or first.fitted.model.causes[0].name == "unknown"
    if alone and first.learned and float(error(problem, first.fitted.residual).max()) < 1.02 * catalogue:
        return first
    if alone and not first.learned and (first.gain > 0.3 or not search.current.model.causes):
        return first
    last = candidates[-1]
    after = float(error(problem, last.fitted.residual).max()) if last.learned else catalogue * (1 - last.gain)
    return last if 1.0 - after / catalogue > SHARE else None


__all__ = ["Unknown", "look", "without"]
