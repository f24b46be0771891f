"""One stepper for the force model with any causes in it.

Fourth-order Runge-Kutta within the sample interval; a strand is taut while min(d, T/c) > 0, and each switch is located
before the step goes on (a fixed step that runs over a switch is wrong by the jump b d').
"""

from __future__ import annotations

import math

from numba import njit

from twin.kernels import composed_slots as k
from twin.kernels.composed_call import call_dynamics

_V = "float64[::1]"
_M = "float64[:,::1]"
_A = "int64[::1]"
_HOOKS = f"{_A},{_M},{_A},{_M}"
_STAGES = 4
_LOCATE = 30
STEP = 0.5001e-3


@njit(f"void({_V},{_V},{_A},{_M},int64,int64)", cache=True, nogil=True)
def _strands(q, c, before, bp, taut1, taut2):  # type: ignore[no-untyped-def]
    q[k.C1] = c[k.K_C1]
    q[k.C2] = c[k.K_C2]
    q[k.B1] = c[k.K_B1]
    q[k.B2] = c[k.K_B2]
    q[k.RIM] = c[k.K_RIM]
    q[k.REST] = c[k.K_REST]
    q[k.RADIUS] = c[k.K_RADIUS]
    q[k.E1] = 0.0
    q[k.E2] = 0.0
    q[k.R] = 0.0
    q[k.PULL] = 0.0
    q[k.SHARED] = 0.0
    q[k.GAMMA1] = 1.0
    q[k.D1] = q[k.S] - q[k.U] + c[k.K_REST] / c[k.K_C1] + c[k.K_OFFSET]
    q[k.DD1] = q[k.W] - q[k.V]
    q[k.D2] = q[k.X] - q[k.S] + c[k.K_REST] / c[k.K_C2]
    q[k.DD2] = q[k.XD] - q[k.W]
    for i in range(before.shape[0]):
        call_dynamics(before[i], q, bp, i)
    q[k.T1] = q[k.C1] * q[k.D1] + q[k.B1] * q[k.DD1] + q[k.E1] if taut1 else 0.0
    if c[k.K_SYSTEM] == k.WF:
        q[k.T2] = q[k.T1]
    else:
        q[k.T2] = q[k.C2] * q[k.D2] + q[k.B2] * q[k.DD2] + q[k.E2] if taut2 else 0.0


@njit(f"void({_V},{_V},{_V},float64,float64,float64,{_HOOKS},int64,int64)", cache=True, nogil=True)
def rates(y, q, c, time, x, xd, before, bp, after, ap, taut1, taut2):  # type: ignore[no-untyped-def]
    """Fill q from the state y = (u, v, s, w, own states); RATE.. and q[k.G], tensions as the modes say."""
    q[k.TIME] = time
    q[k.U] = y[0]
    q[k.V] = y[1]
    q[k.S] = y[2]
    q[k.W] = y[3]
    q[k.X] = x
    q[k.XD] = xd
    q[k.MASS] = c[k.K_MASS]
    q[k.WEIGHT] = c[k.K_WEIGHT]
    q[k.FRICTION] = c[k.K_FC]
    ratio = y[1] / c[k.K_VS]
    q[k.SMOOTH] = math.tanh(ratio) if abs(ratio) < 18.0 else math.copysign(1.0, ratio)
    q[k.G] = 0.0
    q[k.STIFF] = 0.0
    for i in range(int(c[k.K_OWN])):
        q[k.AUX + i] = y[4 + i]
        q[k.RATE + i] = 0.0
    if c[k.K_SYSTEM] == k.AXIS:
        q[k.T1] = x
        q[k.T2] = x
        q[k.E1] = 0.0
    else:
        _strands(q, c, before, bp, taut1, taut2)
    for i in range(after.shape[0]):
        call_dynamics(after[i], q, ap, i)
    q[k.G] += q[k.FRICTION] * q[k.SMOOTH]


@njit(f"void({_V},{_V},{_V})", cache=True, nogil=True)
def _derivative(q, c, dy):  # type: ignore[no-untyped-def]
    dy[0] = q[k.V]
    dy[2] = q[k.W]
    if c[k.K_SYSTEM] == k.WFPD:
        weight = q[k.T1] - q[k.WEIGHT] - q[k.G]
        rim = q[k.T2] - q[k.T1] * q[k.GAMMA1] - q[k.R] + q[k.PULL]
        shared = q[k.SHARED]
        whole = q[k.MASS] * q[k.RIM] - shared * shared
        dy[1] = (q[k.RIM] * weight - shared * rim) / whole
        dy[3] = (q[k.MASS] * rim - shared * weight) / whole
    elif c[k.K_SYSTEM] == k.WF:
        dy[1] = (q[k.T1] - q[k.WEIGHT] - q[k.G]) / q[k.MASS]
        dy[2] = 0.0
        dy[3] = 0.0
    else:
        dy[1] = (q[k.X] + q[k.E1] - q[k.G]) / q[k.MASS]
        dy[2] = 0.0
        dy[3] = 0.0
    for i in range(int(c[k.K_OWN])):
        dy[4 + i] = q[k.RATE + i]


@njit(f"void({_V},float64,float64,{_V})", cache=True, nogil=True)
def hermite(row, theta, dt, out):  # type: ignore[no-untyped-def]
    """x and x' at the fraction theta of an interval; row = (x0, x0', x1, x1')."""
    a, b = row[1] * dt, row[3] * dt
    rise = row[2] - row[0]
    c2 = 3.0 * rise - 2.0 * a - b
    c3 = a + b - 2.0 * rise
    out[0] = row[0] + theta * (a + theta * (c2 + theta * c3))
    out[1] = (a + theta * (2.0 * c2 + 3.0 * theta * c3)) / dt


@njit(
    f"void({_V},{_V},{_V},{_V},float64,float64,float64,float64,{_HOOKS},int64,int64,{_M},{_V})",
    cache=True,
    nogil=True,
)
def _step(y, q, c, row, start, theta, h, dt, before, bp, after, ap, taut1, taut2, work, out):  # type: ignore[no-untyped-def]
    """One Runge-Kutta step of h seconds from y (to which q belongs) into out; the modes stay as they are."""
    drive = work[5]
    n = 4 + int(c[k.K_OWN])
    _derivative(q, c, work[0])
    for stage in range(1, _STAGES):
        fraction = 1.0 if stage == 3 else 0.5
        for i in range(n):
            out[i] = y[i] + fraction * h * work[stage - 1, i]
        hermite(row, theta + fraction * h / dt, dt, drive)
        rates(out, q, c, start + fraction * h, drive[0], drive[1], before, bp, after, ap, taut1, taut2)
        _derivative(q, c, work[stage])
    for i in range(n):
        out[i] = y[i] + h / 6.0 * (work[0, i] + 2.0 * work[1, i] + 2.0 * work[2, i] + work[3, i])


@njit(f"void({_V},{_V})", cache=True, nogil=True)
def gaps(q, gap):  # type: ignore[no-untyped-def]
    """How far each strand is from its switch: min(d, T/c) with T as if taut, m."""
    t1 = q[k.D1] + (q[k.B1] * q[k.DD1] + q[k.E1]) / q[k.C1]
    t2 = q[k.D2] + ((q[k.B2] * q[k.DD2] + q[k.E2]) / q[k.C2] if q[k.C2] > 0.0 else 0.0)
    gap[0] = min(q[k.D1], t1)
    gap[1] = min(q[k.D2], t2)


@njit(f"int64({_V},{_V})", cache=True, nogil=True)
def _pieces(q, c):  # type: ignore[no-untyped-def]
    """Steps in one stretch so that an explicit method is stable and accurate: 1, or as many as damping asks for."""
    rate = q[k.STIFF]
    if c[k.K_SYSTEM] == k.WFPD:
        rate = max(rate, (q[k.B1] + q[k.B2]) / q[k.RIM], math.sqrt((q[k.C1] + q[k.C2]) / q[k.RIM]) * 0.6)
    if abs(q[k.V]) < 4.0 * c[k.K_VS]:
        rate = max(rate, q[k.FRICTION] / (c[k.K_VS] * q[k.MASS]))
    return min(max(1, int(math.ceil(rate * STEP / 1.2))), 40)


@njit(f"void({_V},{_V},{_V},{_V},float64,float64,float64,{_HOOKS},{_M},{_A})", cache=True, nogil=True)
def _at(y, q, c, row, start, theta, dt, before, bp, after, ap, work, mode):  # type: ignore[no-untyped-def]
    """Fill q for the state y at the fraction theta of the interval."""
    hermite(row, theta, dt, work[5])
    rates(y, q, c, start + theta * dt, work[5][0], work[5][1], before, bp, after, ap, mode[0], mode[1])


@njit(f"float64({_V},{_V},{_V},{_V},float64,float64,float64,float64,{_HOOKS},{_M},{_V},{_A})", cache=True, nogil=True)
def _located(y, q, c, row, start, done, theta, dt, before, bp, after, ap, work, out, mode):  # type: ignore[no-untyped-def]
    """The step shortened to the first switch of a strand, and the mode after it."""
    low, high = 0.0, theta
    pulley = c[k.K_SYSTEM] == k.WFPD
    gap = work[4]
    at = theta
    for trial in range(_LOCATE):
        hermite(row, done + at, dt, work[5])
        rates(out, q, c, start + (done + at) * dt, work[5][0], work[5][1], before, bp, after, ap, mode[0], mode[1])
        gaps(q, gap)
        over1 = (gap[0] > 0.0) != (mode[0] == 1)
        over2 = pulley and ((gap[1] > 0.0) != (mode[1] == 1))
        if over1 or over2:
            high = at
        else:
            if trial == 0:
                return theta
            low = at
        if high - low < 1e-5 * theta + 1e-9 or trial == 16:
            break
        at = 0.5 * (low + high)
        _at(y, q, c, row, start, done, dt, before, bp, after, ap, work, mode)
        _step(y, q, c, row, start + done * dt, done, at * dt, dt, before, bp, after, ap, mode[0], mode[1], work, out)
    if at != high:
        _at(y, q, c, row, start, done, dt, before, bp, after, ap, work, mode)
        _step(y, q, c, row, start + done * dt, done, high * dt, dt, before, bp, after, ap, mode[0], mode[1], work, out)
        hermite(row, done + high, dt, work[5])
        rates(out, q, c, start + (done + high) * dt, work[5][0], work[5][1], before, bp, after, ap, mode[0], mode[1])
        gaps(q, gap)
    mode[0] = 1 if gap[0] > 0.0 else 0
    mode[1] = 1 if gap[1] > 0.0 else 0
    _at(out, q, c, row, start, done + high, dt, before, bp, after, ap, work, mode)
    return high


@njit(f"int64({_V},{_V},{_V},{_V},float64,float64,{_HOOKS},{_M},{_V},{_A})", cache=True, nogil=True)
def advance(y, q, c, row, start, dt, before, bp, after, ap, work, out, mode):  # type: ignore[no-untyped-def]
    """Carry y (to which q belongs) over one sample interval; mode[0:2] are the strands' taut flags. 0, or 2 where
    numbers overflow.
    """
    base = max(1, int(math.ceil(dt / STEP)))
    q[k.XDD] = (row[3] - row[1]) / dt
    done = 0.0
    for _ in range(4000):
        if done >= 1.0 - 1e-9:
            break
        theta = min(1.0 / (base * _pieces(q, c)), 1.0 - done)
        _step(y, q, c, row, start + done * dt, done, theta * dt, dt, before, bp, after, ap, mode[0], mode[1], work, out)
        if c[k.K_SYSTEM] == k.AXIS:
            hermite(row, done + theta, dt, work[5])
            rates(out, q, c, start + (done + theta) * dt, work[5][0], work[5][1], before, bp, after, ap, 1, 1)
        else:
            theta = _located(y, q, c, row, start, done, theta, dt, before, bp, after, ap, work, out, mode)
        for i in range(4 + int(c[k.K_OWN])):
            y[i] = out[i]
        done += theta
        if not abs(y[1]) < 100.0:
            return 2
    return 0
