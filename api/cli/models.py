"""List the fibre models, or show one with its parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from api.cli._console import JsonOption, out, quiet, table, write_json

if TYPE_CHECKING:
    from twin.model import FibreModel

EXAMPLE = "stand models force"


def command(
    name: Annotated[str | None, typer.Argument(metavar="[MODEL]", help="Show this model's parameters.")] = None,
    json: JsonOption = None,
) -> None:
    """See the module."""
    from api.catalogue import describe_model, load_models

    models = load_models(name)
    if not quiet(json):
        _show(models, name)
    write_json([describe_model(model) for model in models], json)


def _show(models: list[FibreModel], name: str | None) -> None:
    rows: list[list[Any]] = [[m.name, m.title, ", ".join(sorted(m.systems)), str(m.source)] for m in models]
    out.print(table("Fibre models", ("name", "what it is", "rigs", "source"), rows))
    if name is not None:
        found = [
            [p.name, p.value, p.unit, f"{p.bounds[0]:g} to {p.bounds[1]:g}", p.meaning] for p in models[0].parameters
        ]
        out.print(table("\nParameters beyond the setup", ("name", "nominal", "unit", "bounds", "meaning"), found))
