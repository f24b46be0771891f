"""Say what the simulation gets wrong, what causes it, and what is gained by the extended model."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from api.cli._console import JsonOption, quiet, write_json

EXAMPLE = "stand diagnose runs/*.h5 --json verdict.json"


def command(
    recordings: Annotated[list[Path], typer.Argument(metavar="RUNS...", help="One recording or a campaign.")],
    page: Annotated[Path | None, typer.Option(metavar="FILE", help="Where the page goes.")] = None,
    dask: Annotated[str | None, typer.Option(metavar="ADDRESS", help="Spread the work over this Dask cluster.")] = None,
    json: JsonOption = None,
) -> None:
    """Run the command."""
    from api.cli._after import diagnose_and_tell
    from twin.diagnosis import Options
    from twin.diagnosis.work import Dask, Here

    beside = None if json is None or quiet(json) else json
    with Dask(dask) if dask else Here() as work:
        options = Options(work=work)
        done = diagnose_and_tell(recordings, json=beside, page=page, silent=quiet(json), options=options)
    if quiet(json):
        write_json(done["verdict"], json)
