"""Compare a recording with one or more models: scores, JSON and a page that opens offline."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from api.cli._console import JsonOption, quiet, write_json

EXAMPLE = "stand compare run.h5 --model force --model force-velocity-damping --page report.html"


def command(
    recording: Annotated[
        Path, typer.Argument(metavar="RUN.h5", help="Any recording with /entry/data and /entry/setup.")
    ],
    model: Annotated[
        list[str] | None, typer.Option(help="A model or an extended model's file; may repeat; all.")
    ] = None,
    page: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Where the page goes; beside the recording.")
    ] = None,
    json: JsonOption = None,
) -> None:
    """Run the command."""
    from api.cli._after import compare_and_tell

    models = ["all"] if model and "all" in model else model or ["force"]
    beside = None if json is None or quiet(json) else json
    done = compare_and_tell(recording, models, json=beside, page=page, silent=quiet(json))
    if quiet(json):
        write_json(done["comparison"], json)
