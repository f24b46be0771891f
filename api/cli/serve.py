"""Serve the page, the REST interface and the live stream on loopback."""

from __future__ import annotations

import socket
from pathlib import Path
from typing import Annotated

import typer

from api.cli._stand import HideOption, SeedOption, SimulatedOption, StandOption, configured, serve_arguments

EXAMPLE = "stand serve --simulated --hide guide-viscous-drag"


def command(
    stand: StandOption = None,
    simulated: SimulatedOption = False,
    port: Annotated[int, typer.Option(help="0 takes a free one.", min=0, max=65535)] = 8000,
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="The folder of runs.")] = None,
    token_file: Annotated[Path | None, typer.Option(metavar="FILE", help="Take the token from here.")] = None,
    diagnose: Annotated[bool, typer.Option(help="Diagnose each run after its end.")] = True,
    hide: HideOption = None,
    seed: SeedOption = None,
) -> None:
    """Run the command."""
    import uvicorn

    from api.access import Access, read_token
    from api.app import create_app
    from api.operator import Operator
    from api.priority import prefer
    from stand.targets import make_folder

    prefer()

    with (
        configured(stand, simulated=simulated, arguments=serve_arguments(hide, seed)) as (rig, mock),
        _bind(port) as bound,
    ):
        folder = make_folder(out or rig.storage.folder)
        number = bound.getsockname()[1]
        secret = {"token": read_token(token_file)} if token_file else {}
        access = Access(cookie=f"stand_token_{number}", **secret)
        title = f"{rig.name}{' (simulated)' if mock else ''}"
        operator = Operator(rig, folder, title=title, mount=mock.mount if mock else None, diagnose=diagnose)
        _announce(number, access, shown=token_file is None)
        config = uvicorn.Config(
            create_app(operator, access),
            log_level="warning",
            ws="websockets-sansio",
            ws_per_message_deflate=False,  # on loopback it would only cost time
            timeout_graceful_shutdown=2,
        )
        uvicorn.Server(config).run(sockets=[bound])


def _bind(port: int) -> socket.socket:
    from stand.errors import InputError

    bound = socket.socket()
    bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        bound.bind(("127.0.0.1", port))
    except OSError as error:
        bound.close()
        remedy = "Give another `--port`, or 0 for a free one"
        raise InputError(f"can't listen ({error.strerror})", where="--port", value=port, remedy=remedy) from error
    return bound


def _announce(port: int, access: object, *, shown: bool) -> None:
    token = f"?token={access.token}" if shown else ""  # type: ignore[attr-defined]
    print(f"http://127.0.0.1:{port}/{token}", flush=True)
