"""The engine's results as verdict.md's keys."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from stand.recording import Recording
from stand.setup import SCALARS, System
from stand.units import conversion
from twin.causes._kind import Cause
from twin.diagnosis.clipped import Clip
from twin.diagnosis.findings import findings
from twin.diagnosis.finish import REACHED
from twin.diagnosis.fit import Fitted
from twin.diagnosis.found import Evidence
from twin.diagnosis.hum import Hum
from twin.diagnosis.latent import PLACES
from twin.diagnosis.misfit import error
from twin.diagnosis.precision import covariance, stated
from twin.diagnosis.problem import Problem
from twin.diagnosis.rivals import Standing
from twin.diagnosis.score import Scored
from twin.diagnosis.search import Search
from twin.diagnosis.unknown import Unknown
from twin.diagnosis.verdict import Verdict
from twin.extended import to_toml

Json = dict[str, Any]


def tell(
    recordings: Sequence[Recording],
    skipped: list[dict[str, str]],
    search: Search,
    found: Evidence,
    catalogue: Sequence[Cause],
    ranks: Sequence[Standing],
    lines: Sequence[Hum],
    limits: Sequence[Clip],
    beyond: Unknown | None,
    order: Json | None,
) -> Verdict:
    """The verdict from what the search found and the confirmation measured."""
    spread, _ = covariance(found.problem, found.final)
    causes = [_cause(found, search, c, spread, r) for c, r in zip(_named(found.final), ranks, strict=True)]
    for limit in limits:
        _limited(next(c for c in causes if c["name"] == limit.cause), limit)
    causes += [_hum(line) for line in lines]
    data: Json = {
        "baseline": {"runs": [_baseline(r) for r in recordings], "skipped": skipped},
        "calibration": _calibration(found.final, spread),
        "findings": findings(found, causes, beyond),
        "causes": sorted(causes, key=lambda c: -c["probability"]),
        "unknown": None if beyond is None else _unknown(beyond),
        "not_found": _not_found(search, catalogue, {c["name"] for c in causes}),
        "gain": _gain(found),
        "model": None,
        "next_experiment": order,
        "ladder": [{"name": s.name, "error": s.error, "held_out": s.held_out} for s in found.ladder],
        "notes": list(found.notes),
    }
    return Verdict(data, to_toml(found.final) if found.final.model.causes else "", found)


def _baseline(recording: Recording) -> Json | None:
    if recording.setup.system is System.LINEAR_DRIVE:
        return {"file": recording.name}
    from twin.compare import compare

    run: Json = compare(recording).baseline_run()
    return run


def unit_of(name: str) -> tuple[str, float]:
    """A setup value's unit in files, and the factor to SI."""
    unit = SCALARS.get(name, "1")
    return unit, conversion(unit, unit)


def _calibration(fitted: Fitted, spread: Any) -> Json:
    told: Json = {}
    setup = fitted.model.setup(fitted.z, int(np.argmax([s.added_mass for s in fitted.model.setups])))
    for i, c in enumerate(fitted.model.coordinates):
        if c.owner != "base" or c.name not in SCALARS:
            continue
        unit, factor = unit_of(c.name)
        std = math.sqrt(max(float(spread[i, i]), 0.0)) * c.scale
        if c.name == "guide_friction_velocity":
            std *= setup.guide_friction_velocity
        value = float(getattr(setup, c.name))
        told[c.name] = {"value": value / factor, "std": std / factor, "units": unit, "moved_sigma": float(fitted.z[i])}
    return told


def _named(fitted: Fitted) -> list[Cause]:
    return [c for c in fitted.model.causes if c.name != "unknown"]


def _unknown(beyond: Unknown) -> Json:
    term = beyond.term
    y, std = term.y, term.std
    for cause in beyond.fitted.model.causes:
        if cause.name == "unknown":
            y = np.array(list(beyond.fitted.model.values(beyond.fitted.z, cause).values()))
    return {
        "depends_on": list(beyond.depends_on), "acts_on": term.place, "units": PLACES[term.place][3],
        "probability": 0.9,
        "shape": {"x": term.x, "y": y, "std": std}, "gain": beyond.gain, "against_motion": term.signed,
        "frequency": term.frequency,
    }  # fmt: skip


def _hum(line: Hum) -> Json:
    unit = "N" if line.signal == "fibre_force" else "m"
    sizes = {
        "amplitude": {"value": line.amplitude, "std": line.amplitude_std, "units": unit},
        "frequency": {"value": line.frequency, "std": line.frequency_std, "units": "Hz"},
    }
    told = f"{line.signal} sings at {line.frequency:.2f} Hz with {line.amplitude:.3g} {unit} while the stand rests"
    return {
        "name": "mains-hum", "probability": 0.97, "acts_on": "wiring", "signal": line.signal, "parameters": sizes,
        "indistinguishable_from": [], "strength": line.strength, "evidence": [told],
    }  # fmt: skip


def _cause(found: Evidence, search: Search, cause: Cause, spread: Any, rank: Standing) -> Json:
    fitted = found.final
    values = fitted.model.values(fitted.z, cause)
    parameters: Json = {}
    for p in cause.parameters:
        i = fitted.model.place(cause, p.name)
        std = math.sqrt(max(float(spread[i, i]), 0.0)) * fitted.model.coordinates[i].scale
        null = p.value if p is cause.parameters[0] and p.name not in (*REACHED, "frequency") else 0.0
        std = stated(std, abs(values[p.name] - null), _of_setup(fitted, cause))
        factor = conversion(p.unit, p.unit)
        parameters[p.name] = {"value": values[p.name] / factor, "std": std / factor, "units": p.unit}
    strength = _strength(search, cause)
    chosen = {cause.key: cause.choice} if cause.key and cause.choice else {}
    return {
        "name": cause.name.split("/")[0],
        **chosen,
        "probability": rank.probability,
        "acts_on": cause.acts_on,
        "parameters": parameters,
        "indistinguishable_from": sorted({n.split("/")[0] for n in rank.alike} - {cause.name.split("/")[0]}),
        "strength": strength,
        "evidence": [_sentence(cause, parameters, strength)],
    }


def _of_setup(fitted: Fitted, cause: Cause) -> float:
    """What the setup's other values leave open in a base value: only J/r^2 moves anything."""
    setup = fitted.model.setups[0]
    if cause.base != "pulley_inertia" or setup.pulley_radius <= 0.0:
        return 0.0
    inertia = fitted.model.setup(fitted.z, 0).pulley_inertia
    return 2.0 * setup.sigma("pulley_radius") / setup.pulley_radius * inertia


def _limited(cause: Json, limit: Clip) -> None:
    """A limit that was read off the records."""
    name, told = next(iter(cause["parameters"].items()))
    told["std"] = limit.std
    cause["strength"] = limit.strength
    flat = "flat tops with steep ends stand at one highest level, and were not used"
    braked = "times the weight was braked at one place far harder than by its weight and friction"
    seen = braked if limit.cause == "end-stop" else flat
    size = f"{name} {told['value']:.4g} +- {told['std']:.2g} {told['units']}"
    cause["evidence"] = [f"{limit.flats} {seen} ({limit.cause}): {size}"]


def _strength(search: Search, cause: Cause) -> float:
    """sqrt of the drop of chi^2 per sample, strongest channel, against the best fit without the cause."""
    without = [f for f in search.ladder if cause.name not in f.model.names]
    before = error(search.problem, without[-1].residual)
    after = error(search.problem, search.current.residual)
    return float(np.sqrt(np.max(np.maximum(before - after, 0.0))))


def _sentence(cause: Cause, parameters: Json, strength: float) -> str:
    sizes = ", ".join(f"{n} {v['value']:.4g} +- {v['std']:.2g} {v['units']}" for n, v in parameters.items())
    missed = f"without it the short windows miss by {strength:.1f} times the noise more"
    return f"{cause.title} ({cause.name}): {sizes}; {missed}"


def _not_found(search: Search, catalogue: Sequence[Cause], named: set[str]) -> list[Json]:
    scored: dict[str, Scored] = {s.cause.name: s for s in search.last_scores}
    told: list[Json] = []
    listed: set[str] = set()
    for cause in catalogue:
        if cause.name.split("/")[0] in named | listed:
            continue
        listed.add(cause.name.split("/")[0])
        smallest = scored[cause.name].smallest if cause.name in scored else None
        first = cause.parameters[0]
        factor = conversion(first.unit, first.unit)
        size = None if smallest is None or not math.isfinite(smallest) else smallest / factor
        why = "below what these runs can show" if size is not None else "no run reaches it"
        told.append(
            {"name": cause.name.split("/")[0], "smallest_visible": {first.name: size}, "units": first.unit, "why": why}
        )
    return told


def _gain(found: Evidence) -> Json:
    calibrated, final = found.ladder[1], found.ladder[-1]
    ratio = math.hypot(*final.held_out) / max(math.hypot(*calibrated.held_out), 1e-12)
    channels = max(sum(e > 0.0 for e in final.held_out), 1)
    return {
        "held_out": _held_out(found.problem, found.final),
        "prediction_error_ratio": ratio,
        "prediction_error_noise_units": math.hypot(*final.held_out) / math.sqrt(channels),
    }


def _held_out(problem: Problem, fitted: Fitted) -> list[Json]:
    """R and nrmse over each run's held-out windows."""
    told = []
    for r, run in enumerate(problem.runs):
        mine = (problem.windows.run == r) & problem.windows.held
        if not mine.any():
            continue
        entry: Json = {"file": run.name}
        for channel, name in enumerate(("weight_position", "fibre_force")):
            use = problem.windows.use[mine][..., channel]
            if not use.any():
                continue
            data = problem.data[mine][..., channel][use]
            left = fitted.residual[mine][..., channel][use]
            entry[name] = {
                "R": float(np.corrcoef(data, data - left)[0, 1]),
                "nrmse": float(np.std(left) / np.ptp(data)),
            }
        told.append(entry)
    return told
