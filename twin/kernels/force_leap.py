# mypy: allow-untyped-defs, allow-untyped-calls
"""Whole samples at one product with a propagator each, as long as nothing can switch within them."""

from __future__ import annotations

import math

from twin.kernels.force_layout import B1, B2, C1, C2, DRY_SPEED, REST, RIM, THRESHOLD
from twin.kernels.force_series import CREEPING, SLIDING
from twin.kernels.jit import part

#: |v|/v_s above which tanh is 1, and below which it is its argument, to rounding
SLIDES, CREEPS = 19.0, 4e-6


@part
def respond_with(M, j, sign, u, v, s, w, a0, a1, a2, a3):
    """Output j of the propagator."""
    return (
        (M[8, j] + sign * M[9, j] + (u * M[0, j] + v * M[1, j]))
        + (s * M[2, j] + w * M[3, j])
        + ((a0 * M[4, j] + a1 * M[5, j]) + (a2 * M[6, j] + a3 * M[7, j]))
    )


@part
def strand(taut, stiff, rest, stretch, damped):
    """Above 0 while the strand stays as it is, N: its tension, or what it lacks to be taut."""
    pull = stiff * stretch + rest
    return pull + damped if taut != 0.0 else -min(pull, pull + damped)


@part
def stays(f0, fm, f1):
    """True where three values and the parabola through them stay well above 0."""
    return min(f0, min(fm, f1)) > abs(f0 - 2.0 * fm + f1) + 0.1 * abs(f1 - f0)


@part
def leap(k, y, M, law, drive, i, dt, out):
    """Carries y exactly from sample i over as many samples as stay in one regime; returns the sample reached."""
    u, v, s, w, taut1, taut2 = y[0], y[1], y[2], y[3], y[4], y[5]
    c1, b1, c2, b2, rest, single = k[C1], k[B1], k[C2], k[B2], k[REST], k[RIM] == 0.0
    sign = 0.0 if law == CREEPING else math.copysign(1.0, v)
    slides, creeps, threshold = SLIDES * k[DRY_SPEED], CREEPS * k[DRY_SPEED], k[THRESHOLD]
    n, per_dt, f2, m2, g2 = len(drive) - 1, 1.0 / dt, 0.0, 0.0, 0.0
    a0, w0 = drive[i, 0], drive[i, 1]
    f1 = strand(taut1, c1, rest, (a0 if single else s) - u, b1 * ((w0 if single else w) - v))
    if not single:
        f2 = strand(taut2, c2, rest, a0 - s, b2 * (w0 - w))
    while i < n:
        a0, w0, x1, w1 = drive[i, 0], drive[i, 1], drive[i + 1, 0], drive[i + 1, 1]
        a1, step = w0 * dt, x1 - a0
        a2, a3 = 3.0 * step - 2.0 * a1 - w1 * dt, a1 + w1 * dt - 2.0 * step
        mu = respond_with(M, 0, sign, u, v, s, w, a0, a1, a2, a3)
        mv = respond_with(M, 1, sign, u, v, s, w, a0, a1, a2, a3)
        nu = respond_with(M, 4, sign, u, v, s, w, a0, a1, a2, a3)
        nv = respond_with(M, 5, sign, u, v, s, w, a0, a1, a2, a3)
        if law == SLIDING and (mv * sign <= slides or nv * sign <= slides):
            break
        fastest = max(abs(v), max(abs(mv), abs(nv)))
        if law == CREEPING and fastest >= creeps:
            break
        if fastest + abs(v - 2.0 * mv + nv) > threshold:
            break
        xm, wm = a0 + 0.5 * (a1 + 0.5 * (a2 + 0.5 * a3)), (a1 + a2 + 0.75 * a3) * per_dt
        if single:
            ms, mw, ns, nw = xm, wm, x1, w1
        else:
            ms = respond_with(M, 2, sign, u, v, s, w, a0, a1, a2, a3)
            mw = respond_with(M, 3, sign, u, v, s, w, a0, a1, a2, a3)
            ns = respond_with(M, 6, sign, u, v, s, w, a0, a1, a2, a3)
            nw = respond_with(M, 7, sign, u, v, s, w, a0, a1, a2, a3)
            m2 = strand(taut2, c2, rest, xm - ms, b2 * (wm - mw))
            g2 = strand(taut2, c2, rest, x1 - ns, b2 * (w1 - nw))
            if not stays(f2, m2, g2):
                break
        m1 = strand(taut1, c1, rest, ms - mu, b1 * (mw - mv))
        g1 = strand(taut1, c1, rest, ns - nu, b1 * (nw - nv))
        if not stays(f1, m1, g1):
            break
        u, v, f1, f2 = nu, nv, g1, g2
        if not single:
            s, w = ns, nw
        out[i, 0], out[i, 1] = u, v
        out[i, 2] = (g1 if taut1 != 0.0 else 0.0) if single else (g2 if taut2 != 0.0 else 0.0)
        i += 1
    y[0], y[1], y[2], y[3] = u, v, s, w
    return i
