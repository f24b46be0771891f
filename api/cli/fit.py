"""Tune chosen parameters to recordings, with uncertainties and a plain word where the data do not determine one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from api.cli._console import JsonOption, out, progress, quiet, table, write_json

EXAMPLE = "stand fit runs/*.h5 --parameter fibre_stiffness --parameter fibre_damping"
COLUMNS = ("parameter", "value", "one sigma", "unit", "setup", "remark")


def command(
    recordings: Annotated[list[Path], typer.Argument(metavar="RUNS...", help="Recordings to fit together.")],
    parameter: Annotated[list[str] | None, typer.Option(help="What to tune; may repeat. Setup or model names.")] = None,
    model: Annotated[str, typer.Option(help="The model.")] = "force",
    criterion: Annotated[str, typer.Option(help="windows (short-window error) or psi, (1 - R)^2.")] = "windows",
    json: JsonOption = None,
) -> None:
    """Run the command."""
    from stand.recording import read_recording
    from twin.fit import fit

    runs = [read_recording(path) for path in recordings]
    names = parameter or ["fibre_stiffness", "fibre_damping", "guide_friction"]
    with progress("fitting") as report:
        found = fit(runs, model, names, criterion=criterion, progress=report)
    content: dict[str, Any] = found.to_json()
    if not quiet(json):
        out.print(table(f"{model} fitted to {len(runs)} recording(s)", COLUMNS, _rows(content), right=COLUMNS[1:3]))
    write_json(content, json)


def _rows(content: dict[str, Any]) -> list[list[object]]:
    return [
        [name, p["value"], p["std"], p["units"], p.get("start"), p.get("note")]
        for name, p in content["parameters"].items()
    ]
