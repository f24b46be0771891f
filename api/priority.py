"""Who goes first: the live stream before other programs' work, the work after a run behind it.

Nothing here is real-time: the server computes, and a process that computes in real time keeps the system's own ordinary
workers waiting, through which the bytes of serial ports pass.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

#: nice values, and the server's session's share of the processor
LIVE, AFTERWARDS = -10, 10
#: s after which a thread that waits for the interpreter gets it: an answer must not hold up the stream for long
SWITCH_INTERVAL = 1e-3


def prefer() -> None:
    """This process first among ordinary ones, as far as the system lets it; what it starts inherits that.

    Nice values count only among processes of one session, so the session's share is raised as well.
    """
    sys.setswitchinterval(SWITCH_INTERVAL)
    with suppress(OSError):
        Path("/proc/self/autogroup").write_text(str(LIVE))
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
