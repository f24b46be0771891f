"""The acquisition goes before ordinary work, as far as the system lets it; real-time only where a moment counts.

A serial port's bytes pass through a worker thread of the kernel, which is an ordinary one. A process that computes in
real time keeps it waiting, and falls deaf by its own haste: so only threads that mostly sleep are real-time, and none
while the process starts, prepares or closes its file. Nor is its session's share of the processor raised: that keeps
the worker waiting, too (measured: up to 140 ms).
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import os
from collections.abc import Iterator

REAL_TIME, NICE = 10, -10
#: MCL_CURRENT, MCL_FUTURE, MCL_ONFAULT of mlockall(2)
STAYS = 1 | 2 | 4


def prefer() -> None:
    """This process before ordinary ones of its session, itself an ordinary one."""
    relent()
    with contextlib.suppress(OSError, AttributeError):
        os.setpriority(os.PRIO_PROCESS, 0, NICE)


def keep_at_hand() -> None:
    """What is loaded stays in memory and out of the garbage collector's way.

    A page of code that the system took back is read from the disk again, and a collection of everything (10 to 20 ms)
    holds the interpreter's lock: either holds up every reader.
    """
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).mlockall(STAYS)
    gc.collect()
    gc.freeze()


@contextlib.contextmanager
def ahead() -> Iterator[None]:
    """The calling thread in real time meanwhile, where it is allowed; threads and processes it starts stay so."""
    with contextlib.suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(REAL_TIME))
    try:
        yield
    finally:
        relent()


def relent() -> None:
    """The calling thread is an ordinary one from here on."""
    with contextlib.suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def ordinary_children() -> None:
    """What the calling thread starts from here on begins as an ordinary process, whatever it is itself."""
    with contextlib.suppress(OSError, AttributeError):
        policy, parameters = os.sched_getscheduler(0), os.sched_getparam(0)
        os.sched_setscheduler(0, policy | os.SCHED_RESET_ON_FORK, parameters)
