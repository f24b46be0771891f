"""Errors become one clear message and an exit code."""

from __future__ import annotations

import os
import sys
import traceback

from stand.errors import InputError, StandError

BAD_INPUT, FAILED = 2, 1


def exit_code(error: BaseException) -> int:
    """2 where the user's input is at fault, 1 otherwise."""
    return BAD_INPUT if isinstance(error, InputError) else FAILED


def tell(error: BaseException) -> None:
    """One message on stderr; a traceback only with STAND_TRACEBACK set."""
    if os.environ.get("STAND_TRACEBACK"):
        traceback.print_exception(error)
    print(f"stand: {_sentence(error)}", file=sys.stderr)


def _sentence(error: BaseException) -> str:
    if isinstance(error, StandError):
        return str(error)
    if isinstance(error, OSError):
        return f"{error.filename}: {error.strerror}" if error.filename else str(error)
    at = traceback.extract_tb(error.__traceback__)[-1:]
    where = f" at {at[0].filename}:{at[0].lineno}" if at else ""
    return f"an error of the program itself, {type(error).__name__}: {error}{where} (STAND_TRACEBACK=1 shows the way)"
