"""Show it all on a simulated stand that hides an effect: run, record, compare, diagnose."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Annotated, Any

import typer

from api.cli._console import JsonOption, err, out, write_json
from api.cli._stand import configured, serve_arguments
from stand.errors import InputError

#: effects that the demo's motion, 0.3 m/s, reaches only with another size than their usual one
WITHIN_REACH = {"velocity-dependent-damping": "velocity-dependent-damping:threshold=0.2"}
EXAMPLE = "stand demo --hide guide-viscous-drag --duration 10"


def command(
    hide: Annotated[str | None, typer.Option(metavar="NAME|none", help="What to hide; drawn where not given.")] = None,
    seed: Annotated[int | None, typer.Option(help="Of the draw and of the simulated stand.")] = None,
    duration: Annotated[float, typer.Option(metavar="S", help="Seconds of motion.")] = 10.0,
    folder: Annotated[Path, typer.Option("--out", metavar="DIR", help="Where recording and reports go.")] = Path(
        "runs"
    ),
    json: JsonOption = None,
) -> None:
    """Run the command."""
    from api.cli.run import execute
    from api.orders import Order
    from stand.excitation.spec import Shape

    seed = random.SystemRandom().randrange(2**31) if seed is None else seed
    hidden = draw(seed) if hide is None else None if hide == "none" else hide
    order = Order(shape=Shape.TRAPEZOIDAL, frequency=1.6, amplitude=0.03, ramp=0.2, duration=duration)
    secret = "what it hides is told at the end" if hide is None else f"it hides {hide}"
    err.print(f"A simulated stand starts (seed {seed}); {secret}.")
    with configured(None, simulated=True, arguments=serve_arguments(_reached(hidden), seed)) as (rig, mock):
        assert mock is not None
        err.print(f"It answers at {mock.announcement['drive']['tcp']} (Modbus TCP) and on two serial lines.")
        done = execute(order, rig, folder, title="demo")
    done |= {"hidden": hidden, **_diagnose(Path(done["recording"]))}
    out.print(f"hidden was  [bold]{hidden or 'nothing'}[/bold]")
    write_json(done, json)


def _reached(hidden: str | None) -> list[str]:
    """What the simulated stand is told to hide."""
    return [WITHIN_REACH.get(hidden, hidden)] if hidden else []


def _diagnose(path: Path) -> dict[str, Any]:
    from api.cli._after import diagnose_and_tell

    try:
        return {"verdict": diagnose_and_tell([path])["verdict"]}
    except InputError as error:
        out.print(f"diagnosis   none of this run: {error}")
        return {"verdict": None}


def draw(seed: int) -> str:
    """A hidden effect's name, drawn."""
    from api.simulated import effects

    return random.Random(seed).choice(effects())
