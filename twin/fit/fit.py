"""The fit as a user asks for it, and its result with a plain word about each parameter."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import twin.models
from stand.errors import InputError
from stand.recording import Recording
from twin.fit import correlation
from twin.fit.solve import Progress, Solution, solve
from twin.fit.unknown import Unknown, unknowns
from twin.fit.windows import windows
from twin.model import FibreModel
from twin.plugins import load
from twin.simulate import check_system

CRITERIA = ("windows", "psi")
#: two parameters whose estimates move together this closely are known only together
TOGETHER = 0.98


@dataclass(frozen=True, slots=True)
class Fitted:
    """One tuned value in its shown unit; std: one sigma; note: a plain word where there is something to say."""

    name: str
    units: str
    value: float
    std: float
    bounds: tuple[float, float]
    start: float
    determined: bool
    note: str


@dataclass(frozen=True)
class Fit:
    """before, after: the criterion's value (median mean square in noise units, or the sum of psi)."""

    model: str
    criterion: str
    parameters: tuple[Fitted, ...]
    before: float
    after: float
    files: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """As written to a file: undefined is null."""
        return {
            "model": self.model,
            "criterion": self.criterion,
            "files": list(self.files),
            "before": _number(self.before),
            "after": _number(self.after),
            "parameters": {p.name: _row(p) for p in self.parameters},
        }


def fit(
    recordings: Sequence[Recording],
    model: str | FibreModel,
    parameters: Sequence[str],
    *,
    criterion: str = "windows",
    progress: Progress | None = None,
) -> Fit:
    """Tune `parameters` (names of the setup's or the model's own) of `model` to all recordings together.

    criterion: "windows", the short-window error of u and F, or "psi". InputError for an unknown name or criterion.
    """
    if criterion not in CRITERIA:
        raise InputError("unknown criterion", where="criterion", value=criterion, remedy=" or ".join(CRITERIA))
    if not recordings:
        raise InputError("no recording", where="recordings", remedy="Name at least one")
    chosen_model = load(twin.models, model, FibreModel) if isinstance(model, str) else model
    for recording in recordings:
        check_system(chosen_model, recording.setup)
    chosen = unknowns(recordings[0].setup, chosen_model, parameters)
    tell = progress or (lambda what, share: None)
    if criterion == "psi":
        found = correlation.tune(chosen_model, recordings, chosen, tell)
    else:
        found = solve(chosen_model, windows(recordings), chosen, tell)
    rows = tuple(_fitted(chosen, found, i) for i in range(len(chosen)))
    files = tuple(r.name for r in recordings)
    return Fit(chosen_model.name, criterion, rows, found.before, found.after, files)


def _fitted(chosen: Sequence[Unknown], found: Solution, i: int) -> Fitted:
    unknown, value = chosen[i], float(found.values[i])
    std = math.sqrt(max(float(found.covariance[i, i]), 0.0))
    std = std if std > 0.0 else math.inf
    determined, note = _word(chosen, found, i, value, std)
    f = unknown.factor
    bounds = (unknown.bounds[0] / f, unknown.bounds[1] / f)
    return Fitted(unknown.name, unknown.unit, value / f, std / f, bounds, unknown.value / f, determined, note)


def _word(chosen: Sequence[Unknown], found: Solution, i: int, value: float, std: float) -> tuple[bool, str]:
    unknown = chosen[i]
    low, high = unknown.bounds
    scale = abs(value) or unknown.step
    if not std < 0.5 * scale:
        return False, "the data do not determine it: its uncertainty is over half of its value"
    if min(value - low, high - value) < 1e-9 * scale:
        return False, "it ran into its bound: the data ask for a value outside, or do not determine it"
    twin_name = _partner(chosen, found, i)
    if twin_name:
        return False, f"the data determine it only together with {twin_name}"
    if math.isfinite(unknown.sigma) and std > unknown.sigma:
        return True, "the data say less about it than was believed before"
    return True, ""


def _partner(chosen: Sequence[Unknown], found: Solution, i: int) -> str:
    spread = np.sqrt(np.maximum(np.diag(found.covariance), 1e-300))
    together = np.abs(found.covariance[i] / (spread * spread[i]))
    together[i] = 0.0
    j = int(together.argmax())
    return chosen[j].name if len(chosen) > 1 and together[j] > TOGETHER else ""


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _row(p: Fitted) -> dict[str, Any]:
    return {
        "value": _number(p.value),
        "std": _number(p.std),
        "units": p.units,
        "bounds": [_number(b) for b in p.bounds],
        "start": p.start,
        "determined": p.determined,
        "note": p.note,
    }
