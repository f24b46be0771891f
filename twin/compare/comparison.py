"""What a comparison found: one recording, one or more models."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stand.excitation.spec import Excitation
from twin.compare.measured import Measured
from twin.score import Score

Float = NDArray[np.float64]


@dataclass(frozen=True)
class ModelRun:
    """One model over the recording.

    u, v, F: [n - begin], simulated from `begin` on. short_u (m), short_F (N): rms prediction error over `windows`
    restarts of 0.1 s; passed_over: tenths of a second where the state could not be seen. cost: s of computing.
    """

    name: str
    title: str
    source: str
    parameters: Mapping[str, float]
    u: Float
    v: Float
    F: Float
    score_u: Score
    score_F: Score
    short_u: float
    short_F: float
    windows: int
    passed_over: int
    slack: float
    cost: float


@dataclass(frozen=True)
class Comparison:
    """A recording, its models, and what even a perfect model could reach (`ceiling_u`, `ceiling_F`: R)."""

    name: str
    measured: Measured
    excitation: Excitation | None
    runs: tuple[ModelRun, ...]
    ceiling_u: float
    ceiling_F: float
    notes: tuple[str, ...] = ()
    failed: tuple[tuple[str, str], ...] = ()
    provenance: Mapping[str, Any] = field(default_factory=dict)

    @property
    def baseline(self) -> ModelRun:
        """The force model's run where it is among them, else the first."""
        return next((run for run in self.runs if run.name == "force"), self.runs[0])

    def to_json(self) -> dict[str, Any]:
        """`baseline` of `verdict.md`, every model, provenance; nothing in it is NaN."""
        return {
            "baseline": {"runs": [self.baseline_run()], "skipped": []},
            "models": [self._model(run) for run in self.runs],
            "failed": [{"model": name, "why": why} for name, why in self.failed],
            "first_snatch_s": self.measured.snatch,
            "noise": {"weight_position": self.measured.noise[0], "fibre_force": self.measured.noise[1]},
            "notes": list(self.notes),
            "provenance": dict(self.provenance),
        }

    def baseline_run(self) -> dict[str, Any]:
        """One entry of `baseline.runs`."""
        run = self.baseline
        return {
            "file": self.name,
            "slack_fraction": self.measured.slack,
            "weight_position": run.score_u.to_json() | {"R_ceiling": number(self.ceiling_u)},
            "fibre_force": run.score_F.to_json() | {"R_ceiling": number(self.ceiling_F)},
        }

    def _model(self, run: ModelRun) -> dict[str, Any]:
        return {
            "name": run.name,
            "title": run.title,
            "source": run.source,
            "parameters": dict(run.parameters),
            "weight_position": run.score_u.to_json() | {"short_window_error": number(run.short_u)},
            "fibre_force": run.score_F.to_json() | {"short_window_error": number(run.short_F)},
            "short_windows": run.windows,
            "passed_over": run.passed_over,
            "slack_fraction": run.slack,
            "cost_s": run.cost,
        }


def number(value: float) -> float | None:
    """The value, or None where it is not a number."""
    return value if math.isfinite(value) else None
