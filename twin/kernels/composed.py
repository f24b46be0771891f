# mypy: allow-untyped-defs, allow-untyped-calls
"""Many short windows, a measured run's own states, or one long simulation, all by the composed stepper."""

from __future__ import annotations

import math

import numpy as np

from twin.kernels import composed_slots as k
from twin.kernels.composed_force import begin, evaluate
from twin.kernels.composed_step import DV, FULL, STEP, T2, advance, settle
from twin.kernels.jit import compiler

_V = "float64[::1]"
_M = "float64[:,::1]"
_A = "int64[::1]"
_HOOKS = f"{_A},{_M},{_A},{_M}"

#: most that a state decays over one step of its history, and most steps in STEP s
_DECAY, _PIECES = 0.7, 40

compiled = compiler("composed")


@compiled(f"void({_M},{_M},{_M},{_A},{_A},int64,{_M},float64,{_HOOKS},{_A},float64[:,:,::1],{_A})")
def windows(starts, own, constants, run, first, length, drive, dt, before, bp, after, ap, offset, out, status):
    """Simulate every window.

    starts [w, 4] u, v, s, w; own [w, 8] the causes' states; constants [runs, 14]; run, first [w] the window's run and
    its first sample there; offset [runs] where a run begins in drive [all, 2] (x, x'); out [w, length, 5] u, v, F,
    x'', s; status [w] 0 or 2. A window begins after and ends before the run's first and last sample.
    """
    y, end, q, row = np.empty(FULL), np.empty(FULL), np.zeros(k.SIZE), np.empty(4)
    mode = np.ones(2, np.int64)
    for j in range(len(run)):
        c, at, time = constants[run[j]], offset[run[j]] + first[j], first[j] * dt
        begin(q, c)
        y[:4] = starts[j]
        y[4:DV] = own[j]
        if c[k.K_SYSTEM] != k.WFPD:
            y[3] = 0.0  # no pulley: the fibre's end stands
        q[k.XDD] = (drive[at + 1, 1] - drive[at, 1]) / dt
        mode[0] = mode[1] = 1
        on1, on2 = settle(y, q, c, drive[at, 0], drive[at, 1], time, before, bp, after, ap, mode)
        if c[k.K_SYSTEM] != k.AXIS and not (on1 and on2):
            mode[0] = 1 if on1 else 0
            mode[1] = 1 if on2 else 0
            settle(y, q, c, drive[at, 0], drive[at, 1], time, before, bp, after, ap, mode)
        status[j] = 0
        for i in range(length):
            out[j, i, 0] = y[0]
            out[j, i, 1] = y[1]
            out[j, i, 2] = y[T2]
            out[j, i, 3] = (drive[at + i + 1, 1] - drive[at + i - 1, 1]) / (2.0 * dt)
            out[j, i, 4] = y[2]
            if i == length - 1 or status[j] != 0:
                continue
            row[0] = drive[at + i, 0]
            row[1] = drive[at + i, 1]
            row[2] = drive[at + i + 1, 0]
            row[3] = drive[at + i + 1, 1]
            status[j] = advance(y, q, c, row, (first[j] + i) * dt, dt, before, bp, after, ap, mode, end)


@compiled(f"void({_M},{_V},{_M},{_V},{_M},float64,{_HOOKS},int64,{_M})")
def history(path, force, drive, c, own, dt, before, bp, after, ap, coasts, out):
    """The causes' own states along a measured run: path [n, 4] u, v, s, w; own [1, 8] at its start; coasts: 0 where the
    fibre may slide on the rim, which then is where both strands pull alike; out [n, 8].

    The midpoint rule, its half step from the slope before; as many steps a sample as the rim and the hooks' decay ask
    for. The weight and the drive's end are where they were measured; the rim, which coasts on while the drive strand is
    slack and is held back by the weight's, moves by the strands' pulls from where the path begins. Tensions are what
    the strands give; for the hooks the drive strand's is force [n], N, where that is not negative.
    """
    n, count, coasting = len(path), int(c[k.K_OWN]), c[k.K_SYSTEM] == k.WFPD and coasts != 0
    y, q, mode = np.zeros(FULL), np.zeros(k.SIZE), np.ones(2, np.int64)
    state, slope = own[0].copy(), np.zeros(k.STATES)
    least, most = 1 if dt < 0.6e-3 else 2, _PIECES * int(np.ceil(dt / STEP))
    begin(q, c)
    y[:4] = path[0]
    y[4:DV] = state
    settle(y, q, c, drive[0, 0], drive[0, 1], 0.0, before, bp, after, ap, mode)
    s, w, push = path[0, 2], path[0, 3], 0.0
    for i in range(n):
        out[i] = state
        if i == n - 1:
            break
        q[k.XDD] = (drive[i + 1, 1] - drive[i, 1]) / dt
        rate = q[k.STIFF]
        if coasting:
            rate = max(rate, (q[k.B1] + q[k.B2]) / q[k.RIM], math.sqrt((q[k.C1] + q[k.C2]) / q[k.RIM]))
        pieces = min(max(least, int(np.ceil(dt * rate / _DECAY))), most)
        h = dt / pieces
        for piece in range(pieces):
            theta = (piece + 0.5) / pieces
            for m in range(4):
                y[m] = path[i, m] + theta * (path[i + 1, m] - path[i, m])
            if coasting:
                y[2], y[3] = s + 0.5 * h * w, w + 0.5 * h * push
            x = drive[i, 0] + theta * (drive[i + 1, 0] - drive[i, 0])
            xd = drive[i, 1] + theta * (drive[i + 1, 1] - drive[i, 1])
            told = -1.0
            if force[i] >= 0.0 and force[i + 1] >= 0.0:
                told = force[i] + theta * (force[i + 1] - force[i])
            for m in range(count):
                y[4 + m] = state[m] + 0.5 * h * slope[m]
            on1, on2 = True, True
            for _ in range(2):  # once more where a strand turns out to be slack
                taut1, taut2 = on1, on2
                _, push, _, on1, on2 = evaluate(
                    y[0], y[1], y[2], y[3], x, xd, (i + theta) * dt, y, q, c, before, bp, after, ap, taut1, taut2, told
                )
                if on1 and on2:
                    break
            s += h * (w + 0.5 * h * push)
            w += h * push
            for m in range(count):
                slope[m] = q[k.RATE + m]
                state[m] += h * slope[m]


@compiled(f"int64({_V},{_V},{_M},float64,float64,{_HOOKS},{_A},{_M})")
def carry(y, c, drive, start, dt, before, bp, after, ap, mode, out):
    """Carry y [12], mode [2] (in place) over len(drive) - 1 samples from time `start`; out [n, 5] at samples 1..n."""
    full, end, q, row = np.zeros(FULL), np.zeros(FULL), np.zeros(k.SIZE), np.empty(4)
    n, status = len(drive) - 1, 0
    begin(q, c)
    full[:DV] = y
    if c[k.K_SYSTEM] != k.WFPD:
        full[3] = 0.0
    q[k.XDD] = (drive[1, 1] - drive[0, 1]) / dt
    settle(full, q, c, drive[0, 0], drive[0, 1], start, before, bp, after, ap, mode)
    for i in range(n):
        row[0] = drive[i, 0]
        row[1] = drive[i, 1]
        row[2] = drive[i + 1, 0]
        row[3] = drive[i + 1, 1]
        status = advance(full, q, c, row, start + i * dt, dt, before, bp, after, ap, mode, end)
        if status != 0:
            break
        out[i, 0] = full[0]
        out[i, 1] = full[1]
        out[i, 2] = full[T2]
        out[i, 3] = (drive[i + 1, 1] - drive[i, 1]) / dt
        out[i, 4] = full[2]
    y[:] = full[:DV]
    return status
