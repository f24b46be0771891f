"""Simulated hardware keeps its time on a loaded machine, as real hardware would."""

from __future__ import annotations

import os
from contextlib import suppress

REAL_TIME, NICER = 5, -10


def raise_priority() -> bool:
    """This thread and those it starts before others' programs: real-time where allowed, else a better nice value.

    Whether either was granted.
    """
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(REAL_TIME))
        return True
    with suppress(OSError):
        os.setpriority(os.PRIO_PROCESS, 0, NICER)
        return True
    return False
