# mypy: allow-untyped-defs, allow-untyped-calls
"""The force model where the weight's path runs beside the plane of drive and pulley (asymmetric rig).

The weight's strand swivels: its length is L(u) = sqrt((a - u)^2 + o^2), the share cos = (a - u)/L of its tension pulls
along the guide and the share o/L sideways, which the guide carries with the weight's normal load (Coulomb): friction
grows by sqrt(1 + (T o / (L N))^2). No propagator holds then: Runge-Kutta steps of order 4, short against the pulley's
own frequency, with slack and catch located in them.
"""

from __future__ import annotations

import math

from twin.kernels.force_layout import (
    ALONG,
    B1,
    B2,
    C1,
    C2,
    DAMPING_SLOPE,
    DRY,
    DRY_SPEED,
    MASS,
    NORMAL,
    OFFSET,
    RATIO1,
    RATIO2,
    REST,
    RIM,
    SIGNED,
    STIFFNESS_SLOPE,
    THRESHOLD,
    WEIGHT,
)
from twin.kernels.jit import part

#: s, longest step; halvings that locate a switch
STEP, HALVINGS = 6.25e-5, 44
MOST = 200


@part
def reach(k, u):
    """How much shorter than at rest the weight's strand is, m, and its cosine, where the weight is at u."""
    if k[OFFSET] == 0.0:
        return u, 1.0
    length = math.hypot(k[ALONG] - u, k[OFFSET])
    return math.hypot(k[ALONG], k[OFFSET]) - length, (k[ALONG] - u) / length


@part
def pulls(k, u, v, s, w, x, speed):
    """Stretch and tension (as if taut) of the weight's strand and of the drive's, m, N."""
    near, cosine = reach(k, u)
    beyond = max(0.0, (v if k[SIGNED] != 0.0 else abs(v)) - k[THRESHOLD]) if k[THRESHOLD] < math.inf else 0.0
    single = k[RIM] == 0.0
    far, rate = (x, speed) if single else (s, w)
    d1, d2 = far - near + k[REST] / k[C1], x - s + k[REST] / k[C2]
    c1, b1 = k[C1] + k[RATIO1] * k[STIFFNESS_SLOPE] * beyond, k[B1] + k[RATIO1] * k[DAMPING_SLOPE] * beyond
    p1 = c1 * d1 + b1 * (rate - cosine * v)
    if single:
        return d1, p1, d1, p1
    c2, b2 = k[C2] + k[RATIO2] * k[STIFFNESS_SLOPE] * beyond, k[B2] + k[RATIO2] * k[DAMPING_SLOPE] * beyond
    return d1, p1, d2, c2 * d2 + b2 * (speed - w)


@part
def motion(k, u, v, s, w, x, speed, taut1, taut2):
    """u'' and s'', m/s^2."""
    _, p1, _, p2 = pulls(k, u, v, s, w, x, speed)
    pull = max(p1, 0.0) if taut1 != 0.0 else 0.0
    length = math.hypot(k[ALONG] - u, k[OFFSET])
    friction = k[DRY] * math.tanh(v / k[DRY_SPEED])
    if k[NORMAL] > 0.0:
        friction *= math.hypot(1.0, pull * k[OFFSET] / (length * k[NORMAL]))
    along = (pull * (k[ALONG] - u) / length - k[WEIGHT] - friction) / k[MASS]
    if k[RIM] == 0.0:
        return along, 0.0
    return along, ((max(p2, 0.0) if taut2 != 0.0 else 0.0) - pull) / k[RIM]


@part
def place(cubic, at, dt):
    """x and x' at the share `at` of a sample."""
    x = cubic[0] + at * (cubic[1] + at * (cubic[2] + at * cubic[3]))
    return x, (cubic[1] + at * (2.0 * cubic[2] + 3.0 * at * cubic[3])) / dt


@part
def carried(k, y, cubic, at, share, dt):
    """u, u', s, s' after one Runge-Kutta step over `share` of a sample."""
    h, taut1, taut2 = share * dt, y[4], y[5]
    u, v, s, w = y[0], y[1], y[2], y[3]
    x, speed = place(cubic, at, dt)
    a1, r1 = motion(k, u, v, s, w, x, speed, taut1, taut2)
    x, speed = place(cubic, at + 0.5 * share, dt)
    v2, w2 = v + 0.5 * h * a1, w + 0.5 * h * r1
    a2, r2 = motion(k, u + 0.5 * h * v, v2, s + 0.5 * h * w, w2, x, speed, taut1, taut2)
    v3, w3 = v + 0.5 * h * a2, w + 0.5 * h * r2
    a3, r3 = motion(k, u + 0.5 * h * v2, v3, s + 0.5 * h * w2, w3, x, speed, taut1, taut2)
    x, speed = place(cubic, at + share, dt)
    v4, w4 = v + h * a3, w + h * r3
    a4, r4 = motion(k, u + h * v3, v4, s + h * w3, w4, x, speed, taut1, taut2)
    return (
        u + h / 6.0 * (v + 2.0 * (v2 + v3) + v4),
        v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4),
        s + h / 6.0 * (w + 2.0 * (w2 + w3) + w4),
        w + h / 6.0 * (r1 + 2.0 * (r2 + r3) + r4),
    )


@part
def margins(k, y, u, v, s, w, x, speed):
    """Above 0 while a strand stays as it is: its tension, or what it lacks to be taut; for both strands."""
    d1, p1, d2, p2 = pulls(k, u, v, s, w, x, speed)
    one = p1 if y[4] != 0.0 else max(-d1 * k[C1], -p1)
    two = p2 if y[5] != 0.0 else max(-d2 * k[C2], -p2)
    return one, (1.0 if k[RIM] == 0.0 else two)


@part
def stretch(k, y, cubic, at, share, dt):
    """Carries y over `share` of a sample or to the first switch in it; returns the share reached."""
    u, v, s, w = carried(k, y, cubic, at, share, dt)
    x, speed = place(cubic, at + share, dt)
    one, two = margins(k, y, u, v, s, w, x, speed)
    low, high = 0.0, share
    if one < 0.0 or two < 0.0:
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            um, vm, sm, wm = carried(k, y, cubic, at, middle, dt)
            x, speed = place(cubic, at + middle, dt)
            a, b = margins(k, y, um, vm, sm, wm, x, speed)
            if a < 0.0 or b < 0.0:
                high, one, two, u, v, s, w = middle, a, b, um, vm, sm, wm
            else:
                low = middle
        if one < 0.0:
            y[4] = 1.0 - y[4]
        if two < 0.0:
            y[5] = 1.0 - y[5]
    y[0], y[1], y[2], y[3] = u, v, s, w
    return high


@part
def advance_offset(k, y, cubic, drive, dt, out):
    """`force.advance` for a rig with a lateral offset; the same states and Status."""
    parts = max(1, int(math.ceil(dt / STEP - 1e-6)))
    for i in range(len(drive) - 1):
        x0, w0, x1, w1 = drive[i, 0], drive[i, 1] * dt, drive[i + 1, 0], drive[i + 1, 1] * dt
        cubic[0], cubic[1] = x0, w0
        cubic[2], cubic[3] = 3.0 * (x1 - x0) - 2.0 * w0 - w1, w0 + w1 - 2.0 * (x1 - x0)
        for step in range(parts):
            at, end, turns = step / parts, (step + 1) / parts, 0
            while at < end:
                before = at
                at += stretch(k, y, cubic, at, end - at, dt)
                turns += 1
                if turns > MOST:
                    return 3
                if at <= before:
                    break
        if not math.isfinite(y[0] + y[1] + y[2] + y[3]):
            return 2
        y[6] = 1.0 if (y[1] if k[SIGNED] != 0.0 else abs(y[1])) > k[THRESHOLD] else 0.0
        _, _, _, p2 = pulls(k, y[0], y[1], y[2], y[3], x1, drive[i + 1, 1])
        out[i, 0], out[i, 1] = y[0], y[1]
        out[i, 2] = max(p2, 0.0) if (y[4] if k[RIM] == 0.0 else y[5]) != 0.0 else 0.0
    return 0
