# mypy: allow-untyped-defs, allow-untyped-calls
"""One stepper for the force model with any causes in it.

Fourth-order Runge-Kutta within the sample interval; a strand is taut while min(d, T/c) > 0, and each switch is located
before the step goes on (a fixed step that runs over a switch is wrong by the jump b d').
"""

from __future__ import annotations

import math

from twin.kernels import composed_slots as k
from twin.kernels.composed_force import evaluate, pace
from twin.kernels.jit import part

_LOCATE = 17
STEP = 0.5001e-3
#: in a state vector y after u, v, s, w and the causes' own states, what belongs to it: v', w', T2, own states' rates
DV, DW, T2, OWN_RATE = 4 + k.STATES, 5 + k.STATES, 6 + k.STATES, 7 + k.STATES
FULL = OWN_RATE + k.STATES


@part(inline="always")
def hermite(row, theta, dt):
    """x and x' at the fraction theta of an interval; row = (x0, x0', x1, x1')."""
    a, b = row[1] * dt, row[3] * dt
    rise = row[2] - row[0]
    c2 = 3.0 * rise - 2.0 * a - b
    c3 = a + b - 2.0 * rise
    return row[0] + theta * (a + theta * (c2 + theta * c3)), (a + theta * (2.0 * c2 + 3.0 * theta * c3)) / dt


@part(inline="always")
def _settle(y, q, c, x, xd, time, before, bp, after, ap, mode):
    """What belongs to the state y: v', w', T2 and the own states' rates, into y; the strands' flags by themselves."""
    dv, dw, t2, on1, on2 = evaluate(
        y[0], y[1], y[2], y[3], x, xd, time, y, q, c, before, bp, after, ap, mode[0] == 1, mode[1] == 1
    )
    y[DV], y[DW], y[T2] = dv, dw, t2
    for i in range(int(c[k.K_OWN])):
        y[OWN_RATE + i] = q[k.RATE + i]
    return on1, on2


@part
def settle(y, q, c, x, xd, time, before, bp, after, ap, mode):
    """`_settle` where it is seldom wanted: called, not spread out."""
    return _settle(y, q, c, x, xd, time, before, bp, after, ap, mode)


@part
def _step(y, q, c, row, start, done, theta, dt, before, bp, after, ap, mode, out):
    """One Runge-Kutta step over the share theta of an interval, from y into out; whether each strand is taut there."""
    own, h = int(c[k.K_OWN]), theta * dt
    taut1, taut2 = mode[0] == 1, mode[1] == 1
    u0, v0, s0, w0 = y[0], y[1], y[2], y[3]
    v, w, dv, dw = v0, w0, y[DV], y[DW]
    sum_v, sum_dv, sum_w, sum_dw = v, dv, w, dw
    for i in range(own):
        q[k.RATE + i] = y[OWN_RATE + i]
        out[OWN_RATE + i] = y[OWN_RATE + i]
    for stage in range(1, 4):
        share = h if stage == 3 else 0.5 * h
        u, s = u0 + share * v, s0 + share * w
        v, w = v0 + share * dv, w0 + share * dw
        for i in range(own):
            out[4 + i] = y[4 + i] + share * q[k.RATE + i]
        x, xd = hermite(row, done + theta * (share / h), dt)
        at = start + done * dt + share
        dv, dw, _, _, _ = evaluate(u, v, s, w, x, xd, at, out, q, c, before, bp, after, ap, taut1, taut2)
        weight = 1.0 if stage == 3 else 2.0
        sum_v, sum_w = sum_v + weight * v, sum_w + weight * w
        sum_dv, sum_dw = sum_dv + weight * dv, sum_dw + weight * dw
        for i in range(own):
            out[OWN_RATE + i] += weight * q[k.RATE + i]
    out[0], out[1] = u0 + h / 6.0 * sum_v, v0 + h / 6.0 * sum_dv
    out[2], out[3] = s0 + h / 6.0 * sum_w, w0 + h / 6.0 * sum_dw
    for i in range(own):
        out[4 + i] = y[4 + i] + h / 6.0 * out[OWN_RATE + i]
    x, xd = hermite(row, done + theta, dt)
    return _settle(out, q, c, x, xd, start + (done + theta) * dt, before, bp, after, ap, mode)


@part(inline="always")
def _pieces(v, q, c, rate):
    """Steps in one stretch so that an explicit method is stable and accurate: 1, or as many as damping asks for."""
    if abs(v) < 4.0 * c[k.K_VS]:
        rate = max(rate, q[k.FRICTION] / (c[k.K_VS] * q[k.MASS]))
    return min(max(1, int(math.ceil(rate * STEP / 1.2))), 40)


@part
def _located(y, q, c, row, start, done, theta, dt, before, bp, after, ap, mode, out):
    """The step shortened to the first switch of a strand, out and the modes after it."""
    pulley = c[k.K_SYSTEM] == k.WFPD
    low, high, at = 0.0, theta, -1.0
    on1, on2 = True, True
    for _ in range(1, _LOCATE):
        if high - low < 1e-5 * theta + 1e-9:
            break
        at = 0.5 * (low + high)
        on1, on2 = _step(y, q, c, row, start, done, at, dt, before, bp, after, ap, mode, out)
        if on1 != (mode[0] == 1) or (pulley and on2 != (mode[1] == 1)):
            high = at
        else:
            low = at
    if at != high:
        on1, on2 = _step(y, q, c, row, start, done, high, dt, before, bp, after, ap, mode, out)
    mode[0] = 1 if on1 else 0
    mode[1] = 1 if on2 else 0
    x, xd = hermite(row, done + high, dt)
    settle(out, q, c, x, xd, start + (done + high) * dt, before, bp, after, ap, mode)
    return high


@part
def advance(y, q, c, row, start, dt, before, bp, after, ap, mode, out):
    """Carry y with what belongs to it over one sample interval; mode[0:2] are the strands' taut flags. 0, or 2 where
    numbers overflow.
    """
    base = max(1, int(math.ceil(dt / STEP)))
    pulley, free = c[k.K_SYSTEM] == k.WFPD, c[k.K_SYSTEM] == k.AXIS
    q[k.XDD] = (row[3] - row[1]) / dt
    done = 0.0
    for _ in range(4000):
        if done >= 1.0 - 1e-9:
            break
        theta = min(1.0 / (base * _pieces(y[1], q, c, pace(q, c))), 1.0 - done)
        on1, on2 = _step(y, q, c, row, start, done, theta, dt, before, bp, after, ap, mode, out)
        if not free and (on1 != (mode[0] == 1) or (pulley and on2 != (mode[1] == 1))):
            theta = _located(y, q, c, row, start, done, theta, dt, before, bp, after, ap, mode, out)
        y[:] = out
        done += theta
        if not abs(y[1]) < 100.0:
            return 2
    return 0
