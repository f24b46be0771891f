"""The simulated stand as a process: `python -m mocks serve | replay | record | effects | timing`."""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Protocol


class Runs(Protocol):
    """What a process of this kind runs."""

    def start(self) -> dict[str, Any]: ...
    def stop(self) -> None: ...


def main(argv: Sequence[str] | None = None) -> int:
    """Exit code 0; 2 for wrong input; 1 where the stand failed while it ran."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    commands: dict[str, Callable[[list[str]], int]] = {
        "serve": _serve, "replay": _replay, "record": _record, "effects": _effects, "timing": _timing
    }  # fmt: skip
    if not arguments or arguments[0] not in commands:
        print(f"usage: python -m mocks {{{','.join(commands)}}} ... (--help after a command)", file=sys.stderr)
        return 0 if arguments[:1] in (["-h"], ["--help"]) else 2
    from mocks.devices.priority import be_ordinary

    be_ordinary()
    return commands[arguments[0]](arguments[1:])


def _serve(arguments: list[str]) -> int:
    from mocks.config import ConfigError, load, parse_hide

    given = _serve_parser().parse_args(arguments)
    try:
        config = load(given.config)
        seed = config.seed if given.seed is None else given.seed
        config = replace(config, seed=seed, hidden=config.hidden | parse_hide(given.hide))
        if given.added_mass is not None:
            config = replace(config, plant={**config.plant, "added_mass": given.added_mass})
    except ConfigError as error:
        print(error, file=sys.stderr)
        return 2
    from mocks.devices.stand import SimulatedStand

    stand = SimulatedStand(config, given.ledger)
    return run(stand, given.announce, given.parent, lambda: stand.scheduler.error)


def _serve_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m mocks serve", description="Run a simulated stand.")
    parser.add_argument("config", nargs="?", type=Path, help="TOML; the published stand without it")
    parser.add_argument("--seed", type=int)
    parser.add_argument("--hide", action="append", default=[], metavar="NAME[:parameter=value,...]")
    parser.add_argument("--ledger", type=Path, metavar="DIR", help="keep the truth of every sample sent")
    parser.add_argument(
        "--added-mass", nargs="?", type=float, const=5.035, metavar="KG", help="5.035 kg without a value"
    )
    add_process_options(parser)
    return parser


def add_process_options(parser: argparse.ArgumentParser) -> None:
    """What every process of this kind takes."""
    parser.add_argument("--announce", type=Path, metavar="FILE", help="write the announcement there too")
    parser.add_argument("--parent", type=int, metavar="PID", help="end when that process is gone")


def run(stand: Runs, announce: Path | None, parent: int | None, failed: Callable[[], BaseException | None]) -> int:
    """Announce, then wait for a signal, the parent's end or a failure."""
    from mocks.devices.priority import be_ordinary, keep_at_hand, raise_priority

    sys.setswitchinterval(5e-5)
    ending = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: ending.set())
    raise_priority()
    told = stand.start()
    be_ordinary()
    keep_at_hand()
    line = json.dumps(told)
    if announce:
        announce.write_text(line + "\n")
    print(line, flush=True)
    while not ending.wait(0.2):
        if failed() is not None or (parent is not None and not _alive(parent)):
            break
    stand.stop()
    return 1 if failed() is not None else 0


def _alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def _replay(arguments: list[str]) -> int:
    from mocks.replay import main_replay

    return main_replay(arguments)


def _record(arguments: list[str]) -> int:
    from mocks.record import main_record

    return main_record(arguments)


def _timing(arguments: list[str]) -> int:
    from mocks.timing import main_timing

    return main_timing(arguments)


def _effects(arguments: list[str]) -> int:
    from mocks.effects import everything

    told = [
        {
            "name": effect.name,
            "acts_on": effect.acts_on,
            "catalogued": effect.catalogued,
            "sizes": {size.name: size.default for size in effect.sizes},
            "visible": any(s.default != s.null for s in effect.sizes if not s.steady and not s.choices),
        }
        for effect in everything()
    ]
    print(json.dumps(told, allow_nan=False))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
