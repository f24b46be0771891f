"""Check the environment, the ports and the stand, or a recording; redo one that was cut off."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from api.cli._console import JsonOption, out, progress, quiet, table, write_json
from api.cli._errors import FAILED
from api.cli._stand import StandOption

EXAMPLE = "stand doctor --recover runs/20261121T101500.123Z_trapezoidal_1.25Hz.h5"


def command(
    recording: Annotated[Path | None, typer.Argument(metavar="[RUN.h5]", help="Check this recording.")] = None,
    recover: Annotated[Path | None, typer.Option(metavar="FILE", help="Redo this file from its raw streams.")] = None,
    stand: StandOption = None,
    json: JsonOption = None,
) -> None:
    """Run the command."""
    from api.checkup import check_environment, check_recording, check_stand

    if recover is not None:
        _recover(recover)
    target = recover or recording
    with progress("checking") as report:
        found = check_recording(target) if target else check_environment(report)
        if stand is not None and target is None:
            found += check_stand(stand)
    if not quiet(json):
        marks = {"ok": "[green]ok[/green]", "note": "[yellow]note[/yellow]", "bad": "[red]bad[/red]"}
        out.print(table("", ("", "checked", "found"), [[marks[c.state], c.what, c.found] for c in found]))
    write_json([c.view() for c in found], json)
    if any(check.state == "bad" for check in found):
        raise typer.Exit(FAILED)


def _recover(path: Path) -> None:
    from stand.recording.recover import recover

    with progress(f"redoing {path.name}"):
        done = recover(path)
    out.print(f"{path}: {done.seconds_before:.2f} s before, {done.seconds:.2f} s now. {done.guardian}")
