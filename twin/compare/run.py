"""Compare a recording with one or several models."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import twin.models
from stand.errors import InputError, StandError
from stand.recording import Recording
from stand.setup import Setup
from twin.compare.ceiling import ceilings
from twin.compare.comparison import Comparison, ModelRun
from twin.compare.measured import Measured, measured, taut_above
from twin.compare.provenance import provenance
from twin.model import FibreModel
from twin.plugins import load, names
from twin.score import score
from twin.score.windows import total, window_errors
from twin.simulate import run_table

Float = NDArray[np.float64]
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class Choice:
    """A model with its parameters and, where a model file calibrated it, its own setup."""

    model: FibreModel
    parameters: Mapping[str, float] = field(default_factory=dict)
    setup: Setup | None = None
    name: str | None = None


def choose(model: str | Choice | FibreModel, setup: Setup) -> Choice:
    """A choice from a model's name, a model, or the path of a model file (`.toml`)."""
    if isinstance(model, Choice):
        return model
    if isinstance(model, FibreModel):
        return Choice(model)
    if model.endswith(".toml"):
        from twin.extended import load_model

        extended, parameters, calibrated = load_model(model, setup)
        return Choice(extended, parameters, calibrated)
    return Choice(load(twin.models, model, FibreModel))


def choices(models: str | Sequence[str | Choice | FibreModel], setup: Setup) -> tuple[Choice, ...]:
    """The models asked for, in that order; "all" is every model that works on this rig, the force model first."""
    if models == "all" or list(models) == ["all"]:
        every = sorted(names(twin.models), key=lambda name: (name != "force", name))
        found = (choose(name, setup) for name in every)
        return tuple(choice for choice in found if setup.system in choice.model.systems)
    return tuple(choose(model, setup) for model in ([models] if isinstance(models, str) else models))


def compare(
    recording: Recording,
    models: str | Sequence[str | Choice | FibreModel] = ("force",),
    *,
    parameters: Mapping[str, Mapping[str, float]] | None = None,
    progress: Progress | None = None,
) -> Comparison:
    """`recording` beside `models` (names, model files, models, or "all"), each run free from the rest and scored.

    parameters: by model name. A model that fails is listed with its reason; StandError only where all do.
    """
    tell = progress or (lambda what, share: None)
    data, chosen = measured(recording), choices(models, recording.setup)
    runs, failed = [], []
    for i, choice in enumerate(chosen):
        tell(f"simulating {choice.model.title}", i / (len(chosen) + 1))
        try:
            runs.append(run_model(data, choice, (parameters or {}).get(choice.model.name, {})))
        except StandError as error:
            failed.append((choice.name or choice.model.name, str(error)))
    if not runs:
        raise InputError("no model could be run", where=recording.name, value=failed)
    tell("R's ceiling", len(chosen) / (len(chosen) + 1))
    force = choose("force", recording.setup).model
    ceiling = ceilings(data, force, force.constants(recording.setup, {}))
    return Comparison(
        name=recording.name,
        measured=data,
        excitation=recording.excitation,
        runs=tuple(runs),
        ceiling_u=ceiling[0],
        ceiling_F=ceiling[1],
        notes=(*recording.notes, *_notes(recording)),
        failed=tuple(failed),
        provenance=provenance(recording),
    )


def run_model(data: Measured, choice: Choice, parameters: Mapping[str, float]) -> ModelRun:
    """One model free over the run, and restarted over short windows."""
    model, setup = choice.model, choice.setup or data.setup
    values = {p.name: p.value for p in model.parameters} | dict(choice.parameters) | dict(parameters)
    constants = model.constants(setup, values)
    model.warm()
    began = time.perf_counter()
    _, out = run_table(model, constants, data.start, np.ascontiguousarray(data.drive[data.begin :]), data.dt)
    cost = time.perf_counter() - began
    u, F = data.u[data.begin :], data.F[data.begin :]
    errors, passed = window_errors(setup, model, constants, data.drive[data.begin :], u, F, data.dt)
    short_u, short_F = total(errors)
    return ModelRun(
        name=choice.name or model.name,
        title=model.title,
        source=str(model.source),
        parameters=values,
        u=out[:, 0],
        v=out[:, 1],
        F=out[:, 2],
        score_u=score(u, out[:, 0], data.dt),
        score_F=score(F, out[:, 2], data.dt),
        short_u=short_u,
        short_F=short_F,
        windows=len(errors),
        passed_over=passed,
        slack=float(np.mean(out[:, 2] < taut_above(setup, data.noise[1]))),
        cost=cost,
    )


def _notes(recording: Recording) -> list[str]:
    notes = []
    if recording.complete is False:
        notes.append("the recording was not closed: its last second may be missing")
    if recording.quality is not None and np.any(recording.quality):
        share = float(np.mean(recording.quality != 0))
        notes.append(f"{share:.2%} of the samples are marked in quality (no raw sample near, or a fault)")
    if recording.setup.guide_friction_curve is not None:
        notes.append("the setup holds a friction curve: the baseline uses F_c tanh(v/v_s) all the same")
    return notes
