"""List the causes that the diagnosis knows, or show one with its parameters and rivals."""

from __future__ import annotations

from typing import Annotated

import typer

from api.cli._console import JsonOption, out, quiet, table, write_json

EXAMPLE = "stand causes guide-viscous-drag"


def command(
    name: Annotated[str | None, typer.Argument(metavar="[CAUSE]", help="Show this cause's parameters.")] = None,
    json: JsonOption = None,
) -> None:
    """Run the command."""
    from api.catalogue import describe_causes

    found = describe_causes(name)
    if not quiet(json):
        rows = [[c["name"], c["acts_on"], c["title"], ", ".join(c["rivals"]) or None] for c in found]
        out.print(table("Causes", ("name", "acts on", "what it is", "rivals"), rows))
        if name is not None:
            parameters = [[p["name"], p["units"], p["value"], p["meaning"]] for p in found[0]["parameters"]]
            out.print(table("\nParameters", ("name", "unit", "no effect", "meaning"), parameters))
    write_json(found, json)
