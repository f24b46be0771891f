"""The command line, `stand`: one file per command in this folder, loaded when it is asked for."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path

from stand.errors import StandError


def main(arguments: Sequence[str] | None = None) -> None:
    """Run one command and leave with its exit code: 0 done, 2 bad input, 1 anything else."""
    share_kernels()
    sys.exit(run(sys.argv[1:] if arguments is None else arguments))


def share_kernels() -> None:
    """In a checkout, compiled kernels are kept where `make` keeps them: nothing is compiled a second time."""
    checkout = Path(__file__).parents[2]
    if (checkout / "pyproject.toml").is_file():
        os.environ.setdefault("NUMBA_CACHE_DIR", str(checkout / "build" / "numba"))


def run(arguments: Sequence[str]) -> int:
    """The exit code of one command line; whatever goes wrong is told in one message on stderr."""
    from api.cli._build import build
    from api.cli._errors import exit_code, tell

    try:
        build(arguments)(args=list(arguments), prog_name="stand")
    except SystemExit as leaving:
        return leaving.code if isinstance(leaving.code, int) else int(bool(leaving.code))
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return 1
    except (StandError, Exception) as error:
        tell(error)
        return exit_code(error)
    return 0
