"""The plug-ins as plain data, for lists on screens and in JSON."""

from __future__ import annotations

import math
import tomllib
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stand.setup import Setup
from twin.model import FibreModel
from twin.parameter import Parameter
from twin.plugins import load, names

if TYPE_CHECKING:
    from stand.excitation.situations import Situation


def load_models(name: str | None = None) -> list[FibreModel]:
    """All fibre models, or the one of that name; InputError listing the known ones."""
    import twin.models

    return [load(twin.models, found, FibreModel) for found in ([name] if name else names(twin.models))]


def model_names() -> tuple[str, ...]:
    """The fibre models' names; none is loaded."""
    import twin.models

    return names(twin.models)


def describe_parameter(parameter: Parameter) -> dict[str, Any]:
    """Name, unit, value, bounds (null where there is none), uncertainty, meaning."""
    return {
        "name": parameter.name,
        "units": parameter.unit,
        "value": parameter.value,
        "bounds": [bound if math.isfinite(bound) else None for bound in parameter.bounds],
        "uncertainty": parameter.uncertainty,
        "meaning": parameter.meaning,
    }


def describe_model(model: FibreModel) -> dict[str, Any]:
    """Name, title, source, rigs and parameters."""
    return {
        "name": model.name,
        "title": model.title,
        "source": str(model.source),
        "systems": sorted(str(system) for system in model.systems),
        "parameters": [describe_parameter(parameter) for parameter in model.parameters],
    }


def find_model(name: str, setup: Setup) -> tuple[FibreModel, dict[str, float], Setup]:
    """A model by name or by an extended model's file, its parameters, and the setup that goes with it."""
    from twin.compare.run import choose

    choice = choose(name, setup)
    return choice.model, dict(choice.parameters), choice.setup or setup


def describe_situations() -> list[dict[str, Any]]:
    """The presets of the papers, in the form of an order, with the published R where there is one."""
    from stand.excitation.situations import situations

    return [_describe_situation(preset) for preset in situations().values()]


def _describe_situation(preset: Situation) -> dict[str, Any]:
    excitation = {name: value for name, value in asdict(preset.excitation).items() if name != "drop_height"}
    published = {
        channel: {"constant_damping": constant, "velocity_dependent_damping": dependent}
        for channel, (constant, dependent) in preset.published.items()
    }
    return {
        "name": preset.name,
        "title": preset.title,
        "source": preset.source,
        **excitation,
        "added_mass": preset.added_mass,
        "published_R": published,
    }


def describe_profiles() -> list[dict[str, Any]]:
    """The drive profiles by name, found in their folder."""
    import stand.profiles

    folder = Path(stand.profiles.__path__[0]) / "drives"
    found = []
    for file in sorted(folder.glob("*.toml")):
        content = tomllib.loads(file.read_text())
        about = content.get("profile", {})
        keys = ("vendor", "source", "verified")
        found.append({"name": file.stem, "kind": "drive", **{key: about.get(key, "") for key in keys}})
    return found


def describe_causes(name: str | None = None) -> list[dict[str, Any]]:
    """The catalogue's causes, or the one of that name; InputError listing the known ones."""
    import twin.causes
    from twin.causes._kind import Cause

    return [_describe_cause(load(twin.causes, found, Cause)) for found in ([name] if name else names(twin.causes))]


def _describe_cause(cause: Any) -> dict[str, Any]:
    return {
        "name": cause.name,
        "title": cause.title,
        "acts_on": str(cause.acts_on),
        "source": str(cause.source),
        "rivals": list(cause.rivals),
        "parameters": [describe_parameter(parameter) for parameter in cause.parameters],
    }
