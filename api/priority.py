"""Who goes first: the live stream before other programs' work, the work after a run behind it."""

from __future__ import annotations

import os
import sys
from contextlib import suppress

LIVE, AFTERWARDS = -10, 10
#: s after which a thread that waits for the interpreter gets it: an answer must not hold up the stream for long
SWITCH_INTERVAL = 1e-3


def prefer() -> None:
    """This process first, as far as the system lets it; threads and processes that it starts inherit it."""
    sys.setswitchinterval(SWITCH_INTERVAL)
    _nice(LIVE)


def stand_back() -> None:
    """This process behind all others, whatever it inherited."""
    _nice(AFTERWARDS)


def _nice(value: int) -> None:
    with suppress(OSError, AttributeError):
        os.setpriority(os.PRIO_PROCESS, 0, value)
