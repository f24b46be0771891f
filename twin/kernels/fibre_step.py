"""One implicit stepper for every discretised fibre: M(q) v' = f(q, v, z, t) with band-shaped derivatives.

Two-stage singly diagonally implicit Runge-Kutta method, gamma = 1 - 1/sqrt(2), order 2, L-stable, stiffly
accurate (Alexander 1977, Theorem 5). It throws a light mass that hits a unilateral spring back at 1.4 times its
speed, so a step whose stages disagree by more than IMPACT is taken again as implicit Euler steps of half its
length, which only dissipate; so is the step after one that ended in an impact. Unknowns of a stage are its
velocities; Newton's matrix is that of the stage before as long as it converges well. What does not converge is
repeated with half the step.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from twin.kernels.fibre_band import factor, solve
from twin.kernels.jit import compiler, part

compiled = compiler("fibre")

RESIDUAL, TANGENT, SETTLE = 0, 1, 2
GAMMA = 1.0 - 1.0 / math.sqrt(2.0)
TICKS = 1024  # a step can be halved ten times
NEWTON = 10
TOLERANCE = 1e-6  # m/s
IMPACT = 0.03  # m/s: h |a2 - a1| beyond which a step holds an impact


_v, _m = types.float64[::1], types.float64[:, ::1]
#: mode, c, g, x, w, q, v, a, zbase, z, r, band, border -> 1 if sound; the sign of r is M a - f
ASSEMBLE = types.int64(types.int64, _v, types.float64, types.float64, types.float64, _v, _v, _v, _v, _v, _v, _m, _m)
#: c, x, w, q, v, z -> force at the gauge
GAUGE = types.float64(_v, types.float64, types.float64, _v, _v, _v)
_ADVANCE = types.int64(
    types.FunctionType(ASSEMBLE), types.FunctionType(GAUGE), types.int64[::1], _v, _v, _v, _m, types.float64, _m
)


@part
def drive_at(drive, i, part, dt):  # type: ignore[no-untyped-def]
    """x and x' at `part` (0 to 1) of interval i, cubic Hermite."""
    x0, v0, x1, v1 = drive[i, 0], drive[i, 1] * dt, drive[i + 1, 0], drive[i + 1, 1] * dt
    if part == 1.0:
        return x1, drive[i + 1, 1]
    d = x1 - x0
    b, a = 3.0 * d - 2.0 * v0 - v1, v0 + v1 - 2.0 * d
    return x0 + part * (v0 + part * (b + part * a)), (v0 + part * (2.0 * b + part * 3.0 * a)) / dt


@part
def newton(  # type: ignore[no-untyped-def]
    assemble, size, norm, c, g, x, w, qb, vb, zb, qs, vs, acc, zs, r, band, border, edge, factored, tolerance
):
    """Solve one stage from the guess vs: g if the factors it leaves belong to g, 0 if none do, -1 if it failed.

    edge[:-1]: the border solved with the band's factors, edge[-1]: the Schur complement.
    """
    n, k = size[0], size[1]
    m = n - 1
    before, stalls = math.inf, 0
    for iteration in range(NEWTON):
        for j in range(n):
            qs[j] = qb[j] + g * vs[j]
            acc[j] = (vs[j] - vb[j]) / g
        fresh = factored != g
        if assemble(TANGENT if fresh else RESIDUAL, c, g, x, w, qs, vs, acc, zb, zs, r, band, border) == 0:
            return -1.0
        if fresh:
            factor(band, m, k)
            edge[:n] = border[0]
            corner = border[0, m]
            solve(band, edge, m, k)
            edge[m] = corner
            for j in range(m):
                edge[m] -= border[1, j] * edge[j]
            factored = g
        last = r[m]
        solve(band, r, m, k)
        for j in range(m):
            last -= border[1, j] * r[j]
        last /= edge[m]
        largest = abs(last)
        r[m] = last
        for j in range(m):
            r[j] -= edge[j] * last
            largest = max(largest, abs(r[j]) * norm[j])
        if not largest < 1e6:
            return -1.0
        for j in range(n):
            vs[j] -= r[j]
        rate = largest / before
        if largest < tolerance or (iteration > 0 and rate < 0.3 and largest * rate < 0.5 * tolerance):
            for j in range(n):
                qs[j] = qb[j] + g * vs[j]
                acc[j] = (vs[j] - vb[j]) / g
            return factored
        if iteration > 0 and rate > 0.3:
            factored = 0.0
            if fresh and rate > 0.7:
                stalls += 1
                if stalls == 3:
                    return -1.0
        before = largest
    return -1.0


@compiled(_ADVANCE)
def advance(assemble, gauge, size, norm, c, state, drive, dt, out):  # type: ignore[no-untyped-def]
    """`FibreModel.advance` for a model given by its assembly.

    size: unknowns n (the last one borders the band), half band width, inner variables, steps per sample.
    norm: m per unit of each unknown, [n]. state: u, u', q[1:], v[1:], a, z. Returns a Status.
    """
    n, nz, steps = size[0], size[2], size[3]
    q, v, a, z = np.empty(n), np.empty(n), np.empty(n), np.empty(nz)
    q[0], v[0] = state[0], state[1]
    q[1:], v[1:] = state[2 : 1 + n], state[1 + n : 2 * n]
    a[:], z[:] = state[2 * n : 3 * n], state[3 * n : 3 * n + nz]
    padded = n + size[1]
    band, border, r, edge = np.empty((padded, 2 * size[1] + 1)), np.empty((2, n)), np.empty(padded), np.empty(padded)
    q1, v1, a1, z1 = np.empty(n), np.empty(n), np.empty(n), np.empty(nz)
    q2, v2, a2, z2 = np.empty(n), np.empty(n), np.empty(n), np.empty(nz)
    vb, qb, zb = np.empty(n), np.empty(n), np.empty(nz)
    total = steps * TICKS
    for i in range(out.shape[0]):
        position, width, euler, factored = 0, TICKS, 0, 0.0
        while position < total:
            if euler == 0 and a[0] == 0.0:  # the step before ended in an impact
                width, euler, factored = max(width // 2, 1), 2, 0.0
            h = dt * width / total
            tolerance = TOLERANCE * TICKS / width  # a light mass hardly moves in a short step
            g = h if euler > 0 else GAMMA * h
            x, w = drive_at(drive, i, (position + (width if euler > 0 else width * GAMMA)) / total, dt)
            for j in range(n):
                v1[j] = v[j] + g * a[j]
            factored = newton(
                assemble, size, norm, c, g, x, w, q, v, z, q1, v1, a1, z1, r, band, border, edge, factored, tolerance
            )
            if factored >= 0.0 and euler == 0:
                rest = h - g
                for j in range(n):
                    vb[j], qb[j] = v[j] + rest * a1[j], q[j] + rest * v1[j]
                    v2[j] = vb[j] + g * a1[j]
                for j in range(nz):
                    zb[j] = z[j] + rest / g * (z1[j] - z[j])
                x, w = drive_at(drive, i, (position + width) / total, dt)
                factored = newton(
                    assemble,
                    size,
                    norm,
                    c,
                    g,
                    x,
                    w,
                    qb,
                    vb,
                    zb,
                    q2,
                    v2,
                    a2,
                    z2,
                    r,
                    band,
                    border,
                    edge,
                    factored,
                    tolerance,
                )
                jump = 0.0
                if factored >= 0.0:
                    for j in range(n):
                        jump = max(jump, norm[j] * h * abs(a2[j] - a1[j]))
                if jump > IMPACT:
                    factored = -1.0
                if factored >= 0.0:
                    q[:], v[:], a[:], z[:] = q2, v2, a2, z2
            if factored < 0.0:
                if width == 1:
                    return 1
                width, euler, factored = width // 2, max(2 * euler, 2), 0.0
                a[:] = 0.0
                continue
            if euler > 0:
                jump = 0.0
                for j in range(n):
                    jump = max(jump, norm[j] * g * abs(a1[j]))
                q[:], v[:], z[:] = q1, v1, z1
                if jump > IMPACT:
                    a[:] = 0.0
                else:
                    a[:] = a1
                euler -= 1
            assemble(SETTLE, c, g, x, w, q, v, a, z, z, r, band, border)
            position += width
            if width < TICKS and euler == 0:
                while width < TICKS and position % (2 * width) == 0:
                    width *= 2
        out[i, 0], out[i, 1] = q[0], v[0]
        out[i, 2] = gauge(c, drive[i + 1, 0], drive[i + 1, 1], q, v, z)
        if not abs(q[0]) < 1e3:
            return 2
    state[0], state[1] = q[0], v[0]
    state[2 : 1 + n], state[1 + n : 2 * n] = q[1:], v[1:]
    state[2 * n : 3 * n], state[3 * n : 3 * n + nz] = a, z
    return 0
