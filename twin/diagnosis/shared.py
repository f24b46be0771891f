"""Work shared between this thread and a helper: kernels let go of the interpreter's lock."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from itertools import pairwise
from typing import TypeVar

R = TypeVar("R")
#: pieces that equal work is cut into: windows with snatches in them take longer than others
PIECES = 8
#: window samples below which handing over costs more than it gains
WORTH = 1500
_POOL = ThreadPoolExecutor(1)
_IDLE = threading.Semaphore(1)  # the helper, while it has nothing to do


def _renew() -> None:
    """A forked process has no helper yet, whatever its parent's was doing."""
    global _POOL, _IDLE
    _POOL, _IDLE = ThreadPoolExecutor(1), threading.Semaphore(1)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_renew)


def handed(job: Callable[[], R]) -> Future[R] | None:
    """A job that the helper begins at once; None, and nothing is begun, where it is busy."""
    if not _IDLE.acquire(blocking=False):
        return None

    def done() -> R:
        try:
            return job()
        finally:
            _IDLE.release()

    return _POOL.submit(done)


def shared(jobs: Sequence[Callable[[], None]]) -> None:
    """Do all jobs; whoever is free takes the next."""
    left = iter(jobs)  # a list's iterator hands each item to one thread only

    def take() -> None:
        try:
            for job in left:
                job()
        finally:  # where a job failed, the others are left undone, whoever was to do them
            for _ in left:
                pass

    other = handed(take) if len(jobs) > 1 else None
    try:
        take()
    finally:  # also then nobody writes on behind the caller's back
        if other is not None:
            other.result()


def in_turn(jobs: Sequence[Callable[[], R]]) -> list[Callable[[], R]]:
    """Promises of the jobs' results, to be asked for in their order: with each, the next one is begun as well, and no
    other. Jobs must not hang on one another.
    """
    begun: dict[int, Future[R]] = {}

    def promise(i: int) -> R:
        following = i + 1 if i + 1 < len(jobs) and i + 1 not in begun else None
        if i not in begun:
            if following is not None and (its := handed(jobs[following])) is not None:
                begun[following] = its
            begun[i] = _done(jobs[i])
        elif following is not None and not begun[i].done():  # the helper is at it
            begun[following] = _done(jobs[following])
        return begun[i].result()

    return [partial(promise, i) for i in range(len(jobs))]


def _done(job: Callable[[], R]) -> Future[R]:
    """A job that is done here and now, told when it is asked for."""
    future: Future[R] = Future()
    try:
        future.set_result(job())
    except Exception as error:
        future.set_exception(error)
    return future


def spread(n: int, samples: int, work: Callable[[int, int], None]) -> None:
    """work(first, last) over 0..n items of some samples each."""
    if n * samples < WORTH or n < 2:
        work(0, n)
        return
    pieces = min(PIECES, n)
    cuts = [n * i // pieces for i in range(pieces + 1)]
    shared([_piece(work, a, b) for a, b in pairwise(cuts)])


def _piece(work: Callable[[int, int], None], first: int, last: int) -> Callable[[], None]:
    return lambda: work(first, last)
