"""The acquisition goes before ordinary work, as far as the system lets it."""

from __future__ import annotations

import contextlib
import os

REAL_TIME, NICE = 10, -10


def prefer() -> str:
    """Real-time scheduling where it is allowed, else a better nice value, else nothing; which of them, in words.

    Threads and the guardian started from here on inherit it. Reading, judging and stopping take about a fifth of a
    core: they starve nobody; the closing of a recording, which may take more, is done after `relent`.
    """
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(REAL_TIME))
        return "real-time"
    except (OSError, AttributeError):
        pass
    try:
        return f"nice {os.nice(NICE)}"
    except OSError:
        return "ordinary"


def relent() -> None:
    """The calling thread is an ordinary one from here on."""
    with contextlib.suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
