"""Make a recording from columns of numbers and a setup."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from api.cli._console import JsonOption, out, quiet, write_json

EXAMPLE = "stand import measured.csv --setup setup.toml --out measured.h5"


def command(
    file: Annotated[
        Path, typer.Argument(metavar="FILE.csv", help="A heading line with names and units, then numbers.")
    ],
    setup: Annotated[Path, typer.Option(metavar="SETUP.toml", help="The stand as its operator believes it to be.")],
    save: Annotated[Path | None, typer.Option("--out", metavar="FILE.h5", help="FILE.h5 beside the CSV.")] = None,
    json: JsonOption = None,
) -> None:
    """Run the command."""
    from api.checkup import check_recording
    from stand.recording import read_recording
    from stand.recording.import_csv import import_csv

    target = import_csv(file, setup, save)
    run = read_recording(target)
    result = {"recording": str(target), "samples": len(run.time), "rate": 1.0 / run.dt, "notes": list(run.notes)}
    if not quiet(json):
        out.print(f"{target}: {len(run.time)} samples at {1.0 / run.dt:.6g} Hz, {', '.join(run.channels)}")
        for check in check_recording(target):
            if check.state != "ok" and check.what != "closed":
                out.print(f"  {check.state}: {check.what}: {check.found}")
    write_json(result, json)
