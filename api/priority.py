"""Who goes first: the live stream before other programs' work, the work after a run behind it.

Nothing here is real-time, nor is the share of the server's session raised: the bytes of serial ports pass through the
system's own ordinary workers, and what computes with more weight than theirs keeps them waiting (measured: 140 ms).
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress

#: nice values, which count among the processes of a session
LIVE, AFTERWARDS = -10, 10
#: s after which a thread that waits for the interpreter gets it: an answer must not hold up the stream for long
SWITCH_INTERVAL = 1e-3


def prefer() -> None:
    """This process first among its session's ordinary ones, as far as the system lets it; children inherit that."""
    sys.setswitchinterval(SWITCH_INTERVAL)
    first()


def first() -> None:
    """The calling thread before the other ordinary ones of its session."""
    _nice(LIVE)


def stand_back() -> None:
    """This process behind all others, whatever it inherited."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
    _nice(AFTERWARDS)


def _nice(value: int) -> None:
    with suppress(OSError, AttributeError):
        os.setpriority(os.PRIO_PROCESS, 0, value)
