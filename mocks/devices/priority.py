"""Simulated hardware keeps its time on a loaded machine, as real hardware would."""

from __future__ import annotations

import ctypes
import gc
import os
from contextlib import suppress

REAL_TIME, NICER = 5, -10
_LOCK_ALL, _YOUNG = 7, 50_000


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


def be_ordinary() -> None:
    """This thread and what it starts from now on as other programs, whatever it inherited."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def keep_at_hand() -> None:
    """Memory stays where it is once touched, and what lives now is no longer searched for garbage: both cost pauses."""
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).mlockall(_LOCK_ALL)
    gc.collect()
    gc.freeze()
    gc.set_threshold(_YOUNG, 20, 100)
