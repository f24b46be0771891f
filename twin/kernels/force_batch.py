# mypy: allow-untyped-defs, allow-untyped-calls
"""Many force runs at once: one compiled loop, shared out over threads that hold no interpreter lock."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from twin.kernels.force import advance
from twin.kernels.jit import compiler

compiled = compiler("force")
Float = NDArray[np.float64]

#: runs that a thread takes at a time
SHARE = 8


@compiled("void(f8[:, ::1], f8[:, ::1], f8[:, :, ::1], f8, f8[:, :, ::1], i8[::1], i8, i8)")
def advance_some(k, y, drive, dt, out, status, begin, end):
    """Runs begin..end - 1 one after the other; a single drive serves all where only one is given."""
    shared = len(drive) == 1
    for i in range(begin, end):
        status[i] = advance(k[i], y[i], drive[0 if shared else i], dt, out[i])


def advance_many(
    constants: Float, states: Float, drives: Float, dt: float, out: Float, threads: int | None = None
) -> NDArray[np.int64]:
    """Carries runs side by side and returns each one's Status [r].

    constants [r, 22], states [r, 7] (changed in place), drives [r or 1, n + 1, 2], out [r, n, 3]: u, u', F. Each
    run gives the bits that `advance` gives it alone. threads: as many as there are cores where not given.
    """
    runs = len(constants)
    status = np.zeros(runs, dtype=np.int64)
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        shares = range(0, runs, SHARE)
        done = [
            pool.submit(advance_some, constants, states, drives, dt, out, status, begin, min(begin + SHARE, runs))
            for begin in shares
        ]
        for share in done:
            share.result()
    return status
