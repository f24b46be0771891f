"""The plug-ins as plain data, for lists on screens and in JSON."""

from __future__ import annotations

import math
from typing import Any

from twin.model import FibreModel
from twin.parameter import Parameter
from twin.plugins import load, names


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
