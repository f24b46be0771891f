# mypy: allow-untyped-defs, allow-untyped-calls
"""The force model's accelerations at one moment, with whatever hooks the causes bring."""

from __future__ import annotations

import math

from twin.kernels import composed_slots as k
from twin.kernels.composed_call import call_dynamics
from twin.kernels.jit import part

#: N of pull at which a strand that slides on the rim, held by nothing, still counts as taut
NAUGHT = 1e-6


@part
def begin(q, c):
    """q for a run's constants c; without hooks nothing is written there afterwards."""
    q[k.ZERO1], q[k.ZERO2] = c[k.K_REST] / c[k.K_C1] + c[k.K_OFFSET], c[k.K_REST] / c[k.K_C2]
    _afresh(q, c)


@part(inline="always")
def _afresh(q, c):
    q[k.C1], q[k.C2], q[k.B1], q[k.B2] = c[k.K_C1], c[k.K_C2], c[k.K_B1], c[k.K_B2]
    q[k.RIM], q[k.REST], q[k.RADIUS] = c[k.K_RIM], c[k.K_REST], c[k.K_RADIUS]
    q[k.MASS], q[k.WEIGHT], q[k.FRICTION] = c[k.K_MASS], c[k.K_WEIGHT], c[k.K_FC]
    q[k.E1] = q[k.E2] = q[k.R] = q[k.G] = q[k.PULL] = q[k.SHARED] = q[k.STIFF] = 0.0
    q[k.GAMMA1] = 1.0


@part(inline="always")
def evaluate(u, v, s, w, x, xd, time, own, q, c, before, bp, after, ap, taut1, taut2, told=-1.0):
    """v', w', the drive strand's tension, and whether each strand is taut there by itself: d > 0 and T > 0.

    own: the causes' states at 4..; their rates are left in q[RATE..]. The tensions are what taut1 and taut2 say;
    told: the drive strand's as it was measured, N, where it is not negative, for the hooks; the rim feels the strands.
    """
    system = c[k.K_SYSTEM]
    hooked = before.shape[0] + after.shape[0] > 0
    ratio = v / c[k.K_VS]
    smooth = math.tanh(ratio) if abs(ratio) < 18.0 else math.copysign(1.0, ratio)
    c1, c2, b1, b2, e1, e2 = c[k.K_C1], c[k.K_C2], c[k.K_B1], c[k.K_B2], 0.0, 0.0
    d1, dd1 = s - u + q[k.ZERO1], w - v
    d2, dd2 = x - s + q[k.ZERO2], xd - w
    if hooked:
        _afresh(q, c)
        q[k.TIME], q[k.U], q[k.V], q[k.S], q[k.W], q[k.X], q[k.XD] = time, u, v, s, w, x, xd
        q[k.SMOOTH], q[k.D1], q[k.DD1], q[k.D2], q[k.DD2] = smooth, d1, dd1, d2, dd2
        for i in range(int(c[k.K_OWN])):
            q[k.AUX + i] = own[4 + i]
            q[k.RATE + i] = 0.0
        if system != k.AXIS:
            for i in range(before.shape[0]):
                call_dynamics(before[i], q, bp, i)
        c1, c2, b1, b2, e1, e2 = q[k.C1], q[k.C2], q[k.B1], q[k.B2], q[k.E1], q[k.E2]
        d1, dd1, d2, dd2 = q[k.D1], q[k.DD1], q[k.D2], q[k.DD2]
    pull1, pull2 = c1 * d1 + b1 * dd1 + e1, c2 * d2 + b2 * dd2 + e2
    t1 = pull1 if taut1 else 0.0
    felt = pull2 if taut2 else 0.0
    t2 = told if told >= 0.0 else felt
    if system == k.WF:
        t2 = t1
    elif system == k.AXIS:
        t1 = t2 = x
    on1, on2 = d1 > 0.0 and pull1 > -NAUGHT, d2 > 0.0 and pull2 > -NAUGHT
    if not hooked:
        weight = t1 - c[k.K_WEIGHT] - c[k.K_FC] * smooth
        if system == k.WFPD:
            return weight / c[k.K_MASS], (t2 - t1) / c[k.K_RIM], t2, on1, on2
        if system == k.WF:
            return weight / c[k.K_MASS], 0.0, t2, on1, on2
        return (x - c[k.K_FC] * smooth) / c[k.K_MASS], 0.0, t2, on1, on2
    q[k.T1], q[k.T2] = t1, t2
    for i in range(after.shape[0]):
        call_dynamics(after[i], q, ap, i)
    q[k.G] += q[k.FRICTION] * q[k.SMOOTH]
    if system == k.WFPD:
        weight = q[k.T1] - q[k.WEIGHT] - q[k.G]
        rim = q[k.T2] + (felt - t2) - q[k.T1] * q[k.GAMMA1] - q[k.R] + q[k.PULL]
        shared = q[k.SHARED]
        whole = 1.0 / (q[k.MASS] * q[k.RIM] - shared * shared)
        return (q[k.RIM] * weight - shared * rim) * whole, (q[k.MASS] * rim - shared * weight) * whole, t2, on1, on2
    if system == k.WF:
        return (q[k.T1] - q[k.WEIGHT] - q[k.G]) / q[k.MASS], 0.0, t2, on1, on2
    return (q[k.X] + q[k.E1] - q[k.G]) / q[k.MASS], 0.0, t2, on1, on2


@part
def pace(q, c):
    """The fastest decay in 1/s of the strands, the rim and the hooks; the guide's friction apart."""
    rate = q[k.STIFF]
    if c[k.K_SYSTEM] == k.WFPD:
        rate = max(rate, (q[k.B1] + q[k.B2]) / q[k.RIM], math.sqrt((q[k.C1] + q[k.C2]) / q[k.RIM]) * 0.6)
    return rate
