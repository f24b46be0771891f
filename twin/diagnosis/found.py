"""What the report page draws: kept beside the verdict, not in its JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from twin.diagnosis.fit import Fitted
from twin.diagnosis.problem import Problem


@dataclass(frozen=True)
class Step:
    """A rung of the ladder: baseline, calibrated, + cause ...; errors in noise units (u, F), fitted and held out."""

    name: str
    error: tuple[float, float]
    held_out: tuple[float, float]


@dataclass(frozen=True)
class Rival:
    """A cause set that was refitted: names, short-window error (u, F) in noise units, parameters."""

    causes: tuple[str, ...]
    error: tuple[float, float]
    probability: float
    parameters: Mapping[str, Mapping[str, float]]


@dataclass(frozen=True)
class Evidence:
    """problem: all runs (prepared, smoothed) and windows. baseline, calibrated, final: fits over all windows, each with
    .model, .z, .starts and .residual [w, LENGTH, 2] (data - prediction, zero where unused; u in m, F in N)."""

    problem: Problem
    baseline: Fitted
    calibrated: Fitted
    final: Fitted
    ladder: tuple[Step, ...]
    rivals: tuple[Rival, ...]
    notes: tuple[str, ...]
