"""Threads that must not wait behind other work: real-time priority where the system grants it."""

from __future__ import annotations

import os
import threading


def raise_priority() -> str:
    """Put the calling thread first: "real-time", "nice" or "normal", whichever the system allowed.

    What the thread starts does not inherit it.
    """
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(10))
        return "real-time"
    except (OSError, AttributeError):
        pass
    try:
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), -15)
        return "nice"
    except (OSError, AttributeError):
        return "normal"
