"""Work shared between this thread and a helper: kernels let go of the interpreter's lock."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import numpy as np

HELPERS = 1
#: pieces that equal work is cut into: windows with snatches in them take longer than others
PIECES = 6
#: window samples below which handing over costs more than it gains
WORTH = 1500
_POOL = ThreadPoolExecutor(HELPERS)


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

    others = [_POOL.submit(take) for _ in range(min(HELPERS, len(jobs) - 1))]
    try:
        take()
    finally:  # also then nobody writes on behind the caller's back
        for other in others:
            if not other.cancel():
                other.result()


def spread(n: int, samples: int, work: Callable[[int, int], None]) -> None:
    """work(first, last) over 0..n items of some samples each."""
    if n * samples < WORTH or n < 2:
        work(0, n)
        return
    cuts = np.unique(np.linspace(0, n, PIECES + 1).astype(int))
    shared([_piece(work, int(a), int(b)) for a, b in pairwise(cuts)])


def _piece(work: Callable[[int, int], None], first: int, last: int) -> Callable[[], None]:
    return lambda: work(first, last)
