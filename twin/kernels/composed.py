"""Many short windows, a measured run's own states, or one long simulation, all by the composed stepper."""

from __future__ import annotations

import numpy as np
from numba import njit

from twin.kernels import composed_slots as k
from twin.kernels.composed_step import advance, gaps, rates

_V = "float64[::1]"
_M = "float64[:,::1]"
_A = "int64[::1]"
_HOOKS = f"{_A},{_M},{_A},{_M}"


@njit(f"void({_M},{_M},{_M},{_A},{_A},int64,{_M},float64,{_HOOKS},{_A},float64[:,:,::1],{_A})", cache=True, nogil=True)
def windows(starts, own, constants, run, first, length, drive, dt, before, bp, after, ap, offset, out, status):  # type: ignore[no-untyped-def]
    """Simulate every window.

    starts [w, 4] u, v, s, w; own [w, 8] the causes' states; constants [runs, 14]; run, first [w] the window's run and
    its first sample there; offset [runs] where a run begins in drive [all, 2] (x, x'); out [w, length, 5] u, v, F,
    x'', s; status [w] 0 or 2. A window begins after and ends before the run's first and last sample.
    """
    y = np.empty(4 + k.STATES)
    end = np.empty(4 + k.STATES)
    q = np.zeros(k.SIZE)
    work = np.zeros((6, 4 + k.STATES))
    row = np.empty(4)
    mode = np.ones(2, np.int64)
    gap = np.empty(4 + k.STATES)
    for j in range(len(run)):
        c = constants[run[j]]
        y[:4] = starts[j]
        y[4:] = own[j]
        at = offset[run[j]] + first[j]
        q[k.XDD] = (drive[at + 1, 1] - drive[at, 1]) / dt
        rates(y, q, c, first[j] * dt, drive[at, 0], drive[at, 1], before, bp, after, ap, 1, 1)
        mode[0] = 1
        mode[1] = 1
        if c[k.K_SYSTEM] != k.AXIS:
            gaps(q, gap)
            mode[0] = 1 if gap[0] > 0.0 else 0
            mode[1] = 1 if gap[1] > 0.0 else 0
        rates(y, q, c, first[j] * dt, drive[at, 0], drive[at, 1], before, bp, after, ap, mode[0], mode[1])
        status[j] = 0
        for i in range(length):
            out[j, i, 0] = y[0]
            out[j, i, 1] = y[1]
            out[j, i, 2] = q[k.T2]
            out[j, i, 3] = (drive[at + i + 1, 1] - drive[at + i - 1, 1]) / (2.0 * dt)
            out[j, i, 4] = y[2]
            if i == length - 1 or status[j] != 0:
                continue
            row[0] = drive[at + i, 0]
            row[1] = drive[at + i, 1]
            row[2] = drive[at + i + 1, 0]
            row[3] = drive[at + i + 1, 1]
            status[j] = advance(y, q, c, row, (first[j] + i) * dt, dt, before, bp, after, ap, work, end, mode)


@njit(f"void({_M},{_M},{_V},{_M},float64,{_HOOKS},{_M})", cache=True, nogil=True)
def history(path, drive, c, own, dt, before, bp, after, ap, out):  # type: ignore[no-untyped-def]
    """The causes' own states along a measured run: path [n, 4] u, v, s, w; own [1, 8] at its start; out [n, 8].

    Heun's rule, once or twice a sample; tensions are what the strands give on that path.
    """
    n = len(path)
    y = np.empty(4 + k.STATES)
    q = np.zeros(k.SIZE)
    gap = np.empty(2)
    state = own[0].copy()
    slope = np.empty(k.STATES)
    pieces = 1 if dt < 0.6e-3 else 2
    h = dt / pieces
    for i in range(n):
        out[i] = state
        if i == n - 1:
            break
        for piece in range(pieces):
            for half in range(2):
                theta = (piece + half) / pieces
                for m in range(4):
                    y[m] = path[i, m] + theta * (path[i + 1, m] - path[i, m])
                x = drive[i, 0] + theta * (drive[i + 1, 0] - drive[i, 0])
                xd = drive[i, 1] + theta * (drive[i + 1, 1] - drive[i, 1])
                for m in range(int(c[k.K_OWN])):
                    y[4 + m] = state[m] + (h * slope[m] if half else 0.0)
                rates(y, q, c, (i + theta) * dt, x, xd, before, bp, after, ap, 1, 1)
                gaps(q, gap)
                if gap[0] <= 0.0 or gap[1] <= 0.0:
                    taut1, taut2 = int(gap[0] > 0.0), int(gap[1] > 0.0)
                    rates(y, q, c, (i + theta) * dt, x, xd, before, bp, after, ap, taut1, taut2)
                for m in range(int(c[k.K_OWN])):
                    if half:
                        state[m] += 0.5 * h * (slope[m] + q[k.RATE + m])
                    slope[m] = q[k.RATE + m]


@njit(f"int64({_V},{_V},{_M},float64,float64,{_HOOKS},{_A},{_M})", cache=True, nogil=True)
def carry(y, c, drive, start, dt, before, bp, after, ap, mode, out):  # type: ignore[no-untyped-def]
    """Carry y, mode [2] (in place) over len(drive) - 1 samples from time `start`; out [n, 5] at samples 1..n."""
    q = np.zeros(k.SIZE)
    work = np.zeros((6, 4 + k.STATES))
    end = np.empty(4 + k.STATES)
    row = np.empty(4)
    n = len(drive) - 1
    q[k.XDD] = (drive[1, 1] - drive[0, 1]) / dt
    rates(y, q, c, start, drive[0, 0], drive[0, 1], before, bp, after, ap, mode[0], mode[1])
    for i in range(n):
        row[0] = drive[i, 0]
        row[1] = drive[i, 1]
        row[2] = drive[i + 1, 0]
        row[3] = drive[i + 1, 1]
        status = advance(y, q, c, row, start + i * dt, dt, before, bp, after, ap, work, end, mode)
        if status != 0:
            return status
        out[i, 0] = y[0]
        out[i, 1] = y[1]
        out[i, 2] = q[k.T2]
        out[i, 3] = (drive[i + 1, 1] - drive[i, 1]) / dt
        out[i, 4] = y[2]
    return 0
