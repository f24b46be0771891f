"""The stand that a command works on: a configured one, or a simulated one started for it."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stand.errors import InputError

if TYPE_CHECKING:
    from api.simulated import SimulatedStand
    from stand.config import Stand

StandOption = Annotated[
    Path | None, typer.Option("--stand", metavar="STAND.toml", help="The stand's configuration.", show_default=False)
]
SimulatedOption = Annotated[bool, typer.Option("--simulated", help="Start a simulated stand and use that.")]
HideOption = Annotated[
    list[str] | None,
    typer.Option(
        "--hide", metavar="NAME[:p=v,...]", help="An effect the simulated stand hides; may repeat.", show_default=False
    ),
]
SeedOption = Annotated[int | None, typer.Option("--seed", help="Of the simulated stand's draws.", show_default=False)]


def serve_arguments(
    hide: Sequence[str] | None = None, seed: int | None = None, *, added_mass: bool = False
) -> list[str]:
    """Arguments of `python -m mocks` for a simulated stand."""
    arguments = ["serve"]
    for effect in hide or ():
        arguments += ["--hide", effect]
    if seed is not None:
        arguments += ["--seed", str(seed)]
    return [*arguments, "--added-mass"] if added_mass else arguments


@contextmanager
def configured(
    path: Path | None, *, simulated: bool, arguments: Sequence[str] = ("serve",)
) -> Iterator[tuple[Stand, SimulatedStand | None]]:
    """The stand, and the simulated one behind it if there is one; which ends with the block."""
    from api.simulated import SimulatedStand
    from stand.config import load_stand

    if simulated:
        with SimulatedStand(tuple(arguments)) as mock:
            yield load_stand(path).with_links(mock.announcement), mock
        return
    if path is None:
        remedy = "Give `--stand STAND.toml`, or `--simulated` for a simulated stand"
        raise InputError("no stand is named", where="--stand", remedy=remedy)
    yield load_stand(path), None


def check_ports(stand: Stand, path: Path | None) -> None:
    """InputError naming the key where the file puts an instrument on a serial port that this machine hasn't."""
    for name, instrument in stand.instruments.items():
        port = getattr(instrument.link, "port", "")
        if isinstance(port, str) and "://" not in port and not Path(port).exists():
            remedy = f"Plug it in, or name one that is there: {_ports()}"
            raise InputError("no such port", where=f"{path}: {name}.link.port", value=port, remedy=remedy)


def _ports() -> str:
    from serial.tools.list_ports import comports

    return ", ".join(port.device for port in comports()) or "this machine has none"


def hint(text: str) -> None:
    """A remark for the person at the terminal."""
    print(text, file=sys.stderr)
