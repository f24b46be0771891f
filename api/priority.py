"""Who goes first: the live stream before other programs' work, the work after a run behind it."""

from __future__ import annotations

import os
import sys
from contextlib import suppress

#: below the acquisition's and the instruments' real-time priorities; nice values where that is refused
REAL_TIME, LIVE, AFTERWARDS = 1, -10, 10
#: s after which a thread that waits for the interpreter gets it: an answer must not hold up the stream for long
SWITCH_INTERVAL = 1e-3


def prefer() -> None:
    """This process first, as far as the system lets it; threads and processes that it starts inherit it.

    Real-time where it is allowed: nice values count only among processes of one session. Serving takes a fifth of a
    core; everything heavy is done by processes that stand back.
    """
    sys.setswitchinterval(SWITCH_INTERVAL)
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(REAL_TIME))
    except (OSError, AttributeError):
        _nice(LIVE)


def stand_back() -> None:
    """This process behind all others, whatever it inherited."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
    _nice(AFTERWARDS)


def _nice(value: int) -> None:
    with suppress(OSError, AttributeError):
        os.setpriority(os.PRIO_PROCESS, 0, value)
