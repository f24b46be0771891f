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
    DAMPING_SLOPE,
    DRY_SPEED,
    RATIO1,
    RATIO2,
    REST,
    RIM,
    SIGNED,
    STIFFNESS_SLOPE,
    THRESHOLD,
    TOLERANCE,
)
from twin.kernels.force_linear import INPUTS, SLOTS, place_drive, propagator, slot_of
from twin.kernels.force_series import COLUMNS, CREEPING, ROWS, SLIDING, SMOOTH, U, V, compiled, series
from twin.kernels.force_switch import NEVER, SPEED, STRAND1, STRAND2, swing, switch, value

#: |v|/v_s above which tanh is 1 to 1e-12, and below which it is its argument to 1e-12 of F_c
SLIDES, CREEPS = 14.0, 1.5e-4
#: largest change of v/v_s in one series of the tanh
REACH = 4.0
MOST_SWITCHES = 200
FINE, NOT_FINITE, TOO_MANY = 0, 2, 3


@compiled("f8(f8[::1], f8[::1], f8, f8)")
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
    far, rate = (x, w) if single else (y[2], y[3])
    stretch = far - y[0] + k[REST] / k[C1]
    y[4] = 1.0 if stretch > 0.0 and k[C1] * stretch + k[B1] * (rate - y[1]) > 0.0 else 0.0
    stretch = x - y[2] + k[REST] / k[C2] if not single else 0.0
    y[5] = 1.0 if stretch > 0.0 and k[C2] * stretch + k[B2] * (w - y[3]) > 0.0 else 0.0


@compiled("i8(f8[::1], f8[::1])")
def law_at(k, y):
    """Which law serves the guide's friction at this speed."""
    z = abs(y[1]) / k[DRY_SPEED]
    return SLIDING if z > SLIDES else (CREEPING if z < CREEPS else SMOOTH)


@compiled("f8(f8[::1], f8, f8, i8)")
def strand_margin(y, stretch, tension, which):
    """Above 0 while the strand stays as it is, in newtons."""
    return tension if y[3 + which] != 0.0 else -min(stretch, tension)


@compiled("b1(f8, f8, f8)")
def stays(f0, fm, f1):
    """True where three values and the parabola through them stay well above 0."""
    low = min(f0, min(fm, f1))
    bend = abs(f0 - 2.0 * fm + f1)
    return low > bend + 0.1 * abs(f1 - f0)


@compiled("void(f8[::1], f8[::1], f8, f8, f8[::1])")
def margins(k, y, x, w, out):
    """Both strands' margins at a state, N."""
    single = k[RIM] == 0.0
    far, rate = (x, w) if single else (y[2], y[3])
    pull = k[C1] * (far - y[0]) + k[REST]
    out[0] = strand_margin(y, pull, pull + k[B1] * (rate - y[1]), STRAND1)
    if single:
        out[1] = math.inf
        return
    pull = k[C2] * (x - y[2]) + k[REST]
    out[1] = strand_margin(y, pull, pull + k[B2] * (w - y[3]), STRAND2)


@compiled("b1(f8[::1], f8[::1], f8[:, :, ::1], i8, f8[::1], f8, f8[:, ::1], f8[:, ::1])")
def leap(k, y, M, law, cubic, dt, Y, G):
    """One exact step over a whole sample; False, with y untouched, where something may switch within it."""
    sign = 0.0 if law == CREEPING else math.copysign(1.0, y[1])
    for part in range(2):
        for row in range(4):
            total = M[part, row, 8] + sign * M[part, row, 9]
            for column in range(4):
                total += M[part, row, column] * y[column] + M[part, row, 4 + column] * cubic[column]
            Y[part, row] = total
        for j in range(4, 7):
            Y[part, j] = y[j]
    slow, fast = abs(y[1]), abs(y[1])
    for part in range(2):
        if law == SLIDING and Y[part, 1] * sign <= SLIDES * k[DRY_SPEED]:
            return False
        slow, fast = min(slow, abs(Y[part, 1])), max(fast, abs(Y[part, 1]))
    if law == CREEPING and fast >= CREEPS * k[DRY_SPEED]:
        return False
    if fast + abs(y[1] - 2.0 * Y[0, 1] + Y[1, 1]) > k[THRESHOLD]:
        return False
    margins(k, y, cubic[0], cubic[1] / dt, G[0])
    x = cubic[0] + 0.5 * (cubic[1] + 0.5 * (cubic[2] + 0.5 * cubic[3]))
    margins(k, Y[0], x, (cubic[1] + cubic[2] + 0.75 * cubic[3]) / dt, G[1])
    x = cubic[0] + cubic[1] + cubic[2] + cubic[3]
    margins(k, Y[1], x, (cubic[1] + 2.0 * cubic[2] + 3.0 * cubic[3]) / dt, G[2])
    if not (stays(G[0, 0], G[1, 0], G[2, 0]) and (k[RIM] == 0.0 or stays(G[0, 1], G[1, 1], G[2, 1]))):
        return False
    for j in range(4):
        y[j] = Y[1, j]
    return True


@compiled("f8(f8[::1], f8[:, ::1], i8, i8, f8)")
def trusted(k, C, law, terms, size):
    """The share of a step up to which its series holds: converged, and within one law of friction."""
    eta = 1.0
    if size > k[TOLERANCE]:
        eta = min(1.0, 0.9 * (k[TOLERANCE] / size) ** (1.0 / terms))
    z, change = abs(C[V, 0]) / k[DRY_SPEED], swing(C, V, terms, eta) / k[DRY_SPEED]
    reach = max(z - SLIDES + 1.0, 1.0) if law == SLIDING else REACH
    return eta * reach / change if change > reach else eta


@compiled("f8(f8[::1], f8[::1], f8[:, ::1], f8[::1], f8, f8)")
def stride(k, y, C, cubic, at, dt):
    """One series step from share `at` of a sample to its end or to the first switch; returns the share reached."""
    share, single = 1.0 - at, 1.0 if k[RIM] == 0.0 else 0.0
    for j in range(4):
        C[U + j, 0] = y[j]
    place_drive(C, cubic, at, share)
    law = SLIDING if abs(y[1]) > SLIDES * k[DRY_SPEED] else SMOOTH
    sign = math.copysign(1.0, y[1])
    fast = (1.0 if k[SIGNED] != 0.0 else sign) if y[6] != 0.0 else 0.0
    count, size = series(k, C, share * dt, y[4], y[5], law, sign, fast, 1.0)
    terms = int(count)
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


@compiled("i8(f8[::1], f8[::1], f8[:, ::1], f8, f8[:, ::1])")
def advance(k, y, drive, dt, out):
    """Carries y over len(drive) - 1 samples; out[i] = u, u', F at sample i + 1. Returns a Status."""
    C, cubic = np.zeros((ROWS, COLUMNS)), np.zeros(4)
    M, known = np.zeros((SLOTS, 2, 4, INPUTS)), np.zeros(SLOTS)
    Y, G = np.zeros((2, 7)), np.zeros((3, 2))
    for i in range(len(drive) - 1):
        x0, w0, x1, w1 = drive[i, 0], drive[i, 1] * dt, drive[i + 1, 0], drive[i + 1, 1] * dt
        cubic[0], cubic[1] = x0, w0
        cubic[2], cubic[3] = 3.0 * (x1 - x0) - 2.0 * w0 - w1, w0 + w1 - 2.0 * (x1 - x0)
        law, done = law_at(k, y), False
        if law != SMOOTH and y[6] == 0.0:
            slot = slot_of(y[4], y[5], law)
            if known[slot] == 0.0:
                propagator(k, C, dt, y[4], y[5], law, M[slot])
                known[slot] = 1.0
            done = leap(k, y, M[slot], law, cubic, dt, Y, G)
        at, switches = 0.0, 0
        while not done:
            before = at
            at = stride(k, y, C, cubic, at, dt)
            switches += 1
            if at < 0.0 or at >= 1.0:
                done = True
            elif switches > MOST_SWITCHES and at - before < 1e-6:
                return TOO_MANY
        if not math.isfinite(y[0] + y[1] + y[2] + y[3]):
            return NOT_FINITE
        out[i, 0], out[i, 1], out[i, 2] = y[0], y[1], gauge(k, y, x1, drive[i + 1, 1])
    return FINE
