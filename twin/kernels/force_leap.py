# mypy: allow-untyped-defs, allow-untyped-calls
"""Whole samples at one product with a propagator each, as long as nothing can switch within them."""

from __future__ import annotations

from twin.kernels.force_layout import B1, B2, C1, C2, CREEPS, DRY_SPEED, REST, RIM, SLIDES, THRESHOLD
from twin.kernels.force_series import CREEPING, SLIDING
from twin.kernels.jit import part


@part(fastmath={"contract", "reassoc"})
def respond_with(M, acting, end, u, v, s, w, a0, a1, a2, a3):
    """Writes the state at the sample's end into `end` [4]: one product with the propagator, its rows side by side."""
    for j in range(4):
        end[j] = (
            (acting[j] + (u * M[0, j] + v * M[1, j]))
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
def middle(near, rate, far, far_rate, dt, per_dt):
    """Place and speed in the middle of a sample, by the cubic through both ends: to (omega dt)^4 / 384 of a swing."""
    place = 0.5 * (near + far) + 0.125 * dt * (rate - far_rate)
    return place, 1.5 * per_dt * (far - near) - 0.25 * (rate + far_rate)


@part
def leap(k, y, M, acting, sign, end, law, drive, i, dt, out):
    """Carries y exactly from sample i over as many samples as stay in one regime; returns the sample reached."""
    u, v, s, w, taut1, taut2 = y[0], y[1], y[2], y[3], y[4], y[5]
    c1, b1, c2, b2, rest, single = k[C1], k[B1], k[C2], k[B2], k[REST], k[RIM] == 0.0
    slides, creeps, threshold = k[SLIDES] * k[DRY_SPEED], k[CREEPS] * k[DRY_SPEED], k[THRESHOLD]
    n, per_dt, f2, m2, g2 = len(drive) - 1, 1.0 / dt, 0.0, 0.0, 0.0
    a0, w0 = drive[i, 0], drive[i, 1]
    f1 = strand(taut1, c1, rest, (a0 if single else s) - u, b1 * ((w0 if single else w) - v))
    if not single:
        f2 = strand(taut2, c2, rest, a0 - s, b2 * (w0 - w))
    while i < n:
        a0, w0, x1, w1 = drive[i, 0], drive[i, 1], drive[i + 1, 0], drive[i + 1, 1]
        a1, step = w0 * dt, x1 - a0
        a2, a3 = 3.0 * step - 2.0 * a1 - w1 * dt, a1 + w1 * dt - 2.0 * step
        respond_with(M, acting, end, u, v, s, w, a0, a1, a2, a3)
        nu, nv = end[0], end[1]
        mu, mv = middle(u, v, nu, nv, dt, per_dt)
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
            ns, nw = end[2], end[3]
            ms, mw = middle(s, w, ns, nw, dt, per_dt)
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
