# mypy: allow-untyped-defs, allow-untyped-calls
"""Carries the force model from sample to sample (S1 eqs. 1 to 3): exact between switches, switches located.

Where the strands stay as they are and the guide slides or creeps, one product with a propagator is exact; else
Taylor series of up to 20 terms carry the motion from switch to switch. Nothing depends on how calls are split.
"""

from __future__ import annotations

import math

import numpy as np

from twin.kernels.force_layout import (
    B1,
    B2,
    C1,
    C2,
    CREEPS,
    DAMPING_SLOPE,
    DRY_SPEED,
    OFFSET,
    RATIO1,
    RATIO2,
    REST,
    RIM,
    SIGNED,
    SLIDES,
    STIFFNESS_SLOPE,
    THRESHOLD,
    TOLERANCE,
)
from twin.kernels.force_leap import leap
from twin.kernels.force_linear import INPUTS, SLOTS, place_drive, propagator, slot_of
from twin.kernels.force_offset import advance_offset, reach
from twin.kernels.force_series import (
    COLUMNS,
    CREEPING,
    ROWS,
    SLIDING,
    SMOOTH,
    SUM,
    SWING,
    P,
    Q,
    S,
    U,
    V,
    X,
    series,
)
from twin.kernels.force_switch import NEVER, SPEED, STRAND1, STRAND2, swing, switch, value
from twin.kernels.jit import compiler, part

compiled = compiler("force")

#: largest change of v/v_s in one series of the tanh
REACH = 4.0
MOST_SWITCHES = 200
FINE, NOT_FINITE, TOO_MANY = 0, 2, 3


@part
def gauge(k, y, x, w):
    """The tension at the force gauge, N."""
    single = k[RIM] == 0.0
    if (y[4] if single else y[5]) == 0.0:
        return 0.0
    near, rate = (y[0], y[1]) if single else (y[2], y[3])
    c, b, share = (k[C1], k[B1], k[RATIO1]) if single else (k[C2], k[B2], k[RATIO2])
    if y[6] != 0.0:
        beyond = max(0.0, (y[1] if k[SIGNED] != 0.0 else abs(y[1])) - k[THRESHOLD])
        b += share * k[DAMPING_SLOPE] * beyond
        extra = share * k[STIFFNESS_SLOPE] * beyond
        return max(0.0, c * (x - near) + k[REST] + b * (w - rate) + extra * (x - near + k[REST] / c))
    return max(0.0, c * (x - near) + k[REST] + b * (w - rate))


@compiled("void(f8[::1], f8[::1], f8, f8)")
def settle(k, y, x, w):
    """Sets which strands are taut, and whether the threshold is passed, from the motion itself."""
    single = k[RIM] == 0.0
    speed = y[1] if k[SIGNED] != 0.0 else abs(y[1])
    y[6] = 1.0 if speed > k[THRESHOLD] else 0.0
    near, cosine = reach(k, y[0])
    far, rate = (x, w) if single else (y[2], y[3])
    stretch = far - near + k[REST] / k[C1]
    y[4] = 1.0 if stretch > 0.0 and k[C1] * stretch + k[B1] * (rate - cosine * y[1]) > 0.0 else 0.0
    stretch = x - y[2] + k[REST] / k[C2] if not single else 0.0
    y[5] = 1.0 if stretch > 0.0 and k[C2] * stretch + k[B2] * (w - y[3]) > 0.0 else 0.0


@part
def law_at(k, y):
    """Which law serves the guide's friction at this speed."""
    z = abs(y[1]) / k[DRY_SPEED]
    return SLIDING if z > k[SLIDES] else (CREEPING if z < k[CREEPS] else SMOOTH)


@part
def trusted(k, C, law, terms, size):
    """The share of a step up to which its series holds: converged, and within one law of friction."""
    eta = 1.0
    if size > k[TOLERANCE]:
        eta = min(1.0, 0.9 * (k[TOLERANCE] / size) ** (1.0 / terms))
    z, change = abs(C[V, 0]) / k[DRY_SPEED], swing(C, V, terms, eta) / k[DRY_SPEED]
    reach = max(z - k[SLIDES] + 1.0, 1.0) if law == SLIDING else REACH
    return eta * reach / change if change > reach else eta


@part
def calm(k, C, y, law):
    """True where bounds alone show that a converged series holds to the step's end and nothing switches in it."""
    single, moved = k[RIM] == 0.0, C[SUM, SWING + V]
    z = abs(y[1]) / k[DRY_SPEED]
    if moved > k[DRY_SPEED] * (z - k[SLIDES] if law == SLIDING else REACH):
        return False
    speed = y[1] if k[SIGNED] != 0.0 else abs(y[1])
    if (speed - moved <= k[THRESHOLD]) if y[6] != 0.0 else (speed + moved >= k[THRESHOLD]):
        return False
    driven = abs(C[X, 1]) + abs(C[X, 2]) + abs(C[X, 3])
    if y[4] != 0.0:
        if C[P, 0] <= C[SUM, SWING + P]:
            return False
    else:
        far, swung = (C[X, 0], driven) if single else (C[S, 0], C[SUM, SWING + S])
        if -(far - C[U, 0] + k[REST] / k[C1]) <= swung + C[SUM, SWING + U]:
            return False
    if single:
        return True
    if y[5] != 0.0:
        return C[Q, 0] > C[SUM, SWING + Q]
    return -(C[X, 0] - C[S, 0] + k[REST] / k[C2]) > driven + C[SUM, SWING + S]


@part
def stride(k, y, C, cubic, at, dt):
    """One series step from share `at` of a sample to its end or to the first switch; returns the share reached."""
    share, single = 1.0 - at, 1.0 if k[RIM] == 0.0 else 0.0
    for j in range(4):
        C[U + j, 0] = y[j]
    place_drive(C, cubic, at, share)
    law = SLIDING if abs(y[1]) > k[SLIDES] * k[DRY_SPEED] else SMOOTH
    sign = math.copysign(1.0, y[1])
    fast = (1.0 if k[SIGNED] != 0.0 else sign) if y[6] != 0.0 else 0.0
    count, size = series(k, C, share * dt, y[4], y[5], law, sign, fast, 1.0)
    terms = int(count)
    if size <= k[TOLERANCE] and calm(k, C, y, law):
        for j in range(4):
            y[j] = C[SUM, j]
        return 1.0
    end = trusted(k, C, law, terms, size)
    what = 0
    for event in (STRAND1, STRAND2, SPEED):
        if event == STRAND2 and single != 0.0:
            continue
        found = switch(k, C, event, terms, y[3 + event], single, end)
        if found < NEVER and (what == 0 or found < end):
            end, what = found, event
    for j in range(4):
        y[j] = value(C, U + j, terms + 1, end)
    if what != 0:
        y[3 + what] = 1.0 - y[3 + what]
        return at + end * share if end < 1.0 else -1.0
    return 1.0 if end >= 1.0 else at + end * share


@part
def sample(k, y, C, cubic, drive, i, dt):
    """Carries y over the interval after sample i by series, from switch to switch. Returns a Status."""
    x0, w0, x1, w1 = drive[i, 0], drive[i, 1] * dt, drive[i + 1, 0], drive[i + 1, 1] * dt
    cubic[0], cubic[1] = x0, w0
    cubic[2], cubic[3] = 3.0 * (x1 - x0) - 2.0 * w0 - w1, w0 + w1 - 2.0 * (x1 - x0)
    at, steps = 0.0, 0
    while 0.0 <= at < 1.0:
        before = at
        at = stride(k, y, C, cubic, at, dt)
        steps += 1
        if steps > MOST_SWITCHES and 0.0 <= at < before + 1e-6:
            return TOO_MANY
    return FINE if math.isfinite(y[0] + y[1] + y[2] + y[3]) else NOT_FINITE


@compiled("i8(f8[::1], f8[::1], f8[:, ::1], f8, f8[:, ::1])")
def advance(k, y, drive, dt, out):
    """Carries y over len(drive) - 1 samples; out[i] = u, u', F at sample i + 1. Returns a Status."""
    C, cubic = np.zeros((ROWS, COLUMNS)), np.zeros(4)
    if k[OFFSET] > 0.0:
        return advance_offset(k, y, cubic, drive, dt, out)
    M, known = np.zeros((SLOTS, INPUTS, 4)), np.zeros(SLOTS)
    acting, end = np.zeros(4), np.zeros(4)
    i, n = 0, len(drive) - 1
    while i < n:
        law = law_at(k, y)
        if law != SMOOTH and y[6] == 0.0:
            slot = slot_of(y[4], y[5], law)
            if known[slot] == 0.0:
                propagator(k, C, dt, y[4], y[5], law, M[slot])
                known[slot] = 1.0
            sign = 0.0 if law == CREEPING else math.copysign(1.0, y[1])
            for j in range(4):
                acting[j] = M[slot, 8, j] + sign * M[slot, 9, j]
            i = leap(k, y, M[slot], acting, sign, end, law, drive, i, dt, out)
            if i == n:
                break
        status = sample(k, y, C, cubic, drive, i, dt)
        if status != FINE:
            return status
        i += 1
        out[i - 1, 0], out[i - 1, 1], out[i - 1, 2] = y[0], y[1], gauge(k, y, drive[i, 0], drive[i, 1])
    return FINE
