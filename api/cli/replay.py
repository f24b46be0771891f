"""Play a recording's raw bytes through simulated devices, record and compare again."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from api.cli._console import JsonOption, write_json

EXAMPLE = "stand replay runs/20261121T101500.123Z_trapezoidal_1.25Hz.h5 --speed max"


def command(
    recording: Annotated[Path, typer.Argument(metavar="RUN.h5", help="A recording with raw streams.")],
    speed: Annotated[str, typer.Option(metavar="N|max", help="Times true speed, or as fast as possible.")] = "1",
    inject: Annotated[
        bool,
        typer.Option(
            "--inject", help="Use the recorded arrivals (as at any speed but 1): the grid comes out bit-equal."
        ),
    ] = False,
    model: Annotated[str, typer.Option(help="The model that runs beside.")] = "force",
    out: Annotated[Path, typer.Option(metavar="DIR", help="Where the new recording goes.")] = Path("runs/replay"),
    json: JsonOption = None,
) -> None:
    """Run the command."""
    from api.cli._after import check_end, compare_and_tell
    from api.cli._console import out as console
    from api.cli._watch import run_and_watch
    from api.replays import recorded_stand
    from api.simulated import SimulatedStand
    from api.twins import store
    from stand.runs import RunOrder

    factor = parse_speed(speed)
    rig, seconds = recorded_stand(recording)
    out.mkdir(parents=True, exist_ok=True)
    with SimulatedStand(("replay", str(recording), "--speed", speed)) as mock:
        order = RunOrder(
            folder=out,
            replay=True,
            seconds=seconds,
            speed=factor,
            inject=recording if inject or factor != 1.0 else None,
        )
        title = f"replay of {recording.name}"
        last, beside = run_and_watch(
            rig.with_links(mock.announcement), order, model=model, seconds=seconds, title=title
        )
    path = check_end(last, out)
    store(path, beside)
    console.print(f"recording   {path}")
    write_json({"recording": str(path), "replayed": str(recording), **compare_and_tell(path)}, json)


def parse_speed(text: str) -> float:
    """Times true speed; 0 stands for as fast as possible."""
    from stand.errors import InputError

    if text == "max":
        return 0.0
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not 0 < value < float("inf"):
        raise InputError("not a speed", where="--speed", value=text, remedy="A positive number, or max")
    return value
