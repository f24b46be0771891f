"""One implicit stepper for every discretised fibre: M(q) v' = f(q, v, z, t) with band-shaped derivatives.

Singly diagonally implicit Runge-Kutta methods, L-stable and stiffly accurate. Order 2: two stages, gamma =
1 - 1/sqrt(2) (Alexander 1977, Theorem 5). Order 4: five stages after an explicit one, gamma = 1/4 (Kennedy, Carpenter
2003, ESDIRK4(3)6L[2]SA). They throw a light mass that hits a unilateral spring back at up to 1.4 times its speed, so
a step whose stages disagree by more than IMPACT is taken again as implicit Euler steps of half its length, which only
dissipate; so is the step after one that ended in an impact. Unknowns of a stage are its velocities, guessed from the
accelerations of the same stage before; Newton's matrix is kept, from step to step and from call to call, as long as
it converges well. What does not converge is repeated with half the step.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from twin.kernels.fibre_band import factor, solve
from twin.kernels.fibre_memory import keep, recall
from twin.kernels.fibre_tableau import tableau
from twin.kernels.jit import compiler, part

compiled = compiler("fibre")

RESIDUAL, TANGENT, SETTLE = 0, 1, 2
TICKS = 1024  # a step can be halved ten times
FIRST = 64  # ticks of the first step of all
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
    assemble, size, norm, c, g, x, w, qb, vb, zb, qs, vs, acc, zs, r, band, border, edge, factored, tolerance, meter
):
    """Solve one stage from the guess vs: g if the factors it leaves belong to g, 0 if none do, -1 if it failed.

    edge[:-1]: the border solved with the band's factors, edge[-1]: the Schur complement. meter[0]: how fast it
    converged last, believed a little less each time it isn't measured anew (Hairer, Wanner 1996, section IV.8).
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
            if iteration == 0:
                meter[0] = max(meter[0], 0.03)
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
        rate = largest / before if iteration > 0 else meter[0] ** 0.8
        meter[0] = max(rate, 1e-3)
        if largest < tolerance or (rate < 0.3 and largest * rate < 0.5 * tolerance):
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


@part
def step(  # type: ignore[no-untyped-def]
    assemble, size, norm, c, A, drive, i, begin, end, dt, q, v, a, z, zd, guess, same, K, Kz, base, zb, work, factored
):
    """One Runge-Kutta step from share `begin` to `end` of sample i: Newton's mark, -1 if it failed or holds an impact.

    K: rates of velocity and position at the stages [2, s, n]; Kz: those of z. Leaves the step's end in their last.
    """
    n, nz, s = size[0], size[2], len(Kz)
    h = (end - begin) * dt
    g, first = h * A[s - 1, s - 1], 1 if A[0, 0] == 0.0 else 0
    tolerance = TOLERANCE / ((end - begin) * size[3])  # a light mass hardly moves in a short step
    r, band, border, edge, meter = work
    if first == 1:
        K[0, 0], K[1, 0], Kz[0] = a, v, zd
    for m in range(first, s):
        share = A[m, s]
        qb, vb = base[0], base[1]
        qb[:], vb[:], zb[:] = q, v, z
        for l in range(m):
            w = h * A[m, l]
            for j in range(n):
                vb[j] += w * K[0, l, j]
                qb[j] += w * K[1, l, j]
            for j in range(nz):
                zb[j] += w * Kz[l, j]
        for j in range(n):
            K[1, m, j] = vb[j] + g * (guess[m, j] if same else (a[j] if m == 0 else K[0, m - 1, j]))
        x, speed = drive_at(drive, i, begin + share * (end - begin), dt)
        factored = newton(
            assemble, size, norm, c, g, x, speed, qb, vb, zb, base[2], K[1, m], K[0, m], Kz[m], r, band, border, edge,
            factored, tolerance, meter,
        )  # fmt: skip
        if factored < 0.0:
            return factored
        if m > first:
            for j in range(n):
                if norm[j] * h * abs(K[0, m, j] - K[0, m - 1, j]) > IMPACT:
                    return -1.0
        if m == s - 1:
            z[:] = Kz[m]
        for j in range(nz):
            Kz[m, j] = (Kz[m, j] - zb[j]) / g
    q[:] = base[2]
    return factored


@compiled(_ADVANCE)
def advance(assemble, gauge, size, norm, c, state, drive, dt, out):  # type: ignore[no-untyped-def]
    """`FibreModel.advance` for a model given by its assembly.

    size: unknowns n (the last one borders the band), half band width, inner variables, steps per sample, order.
    norm: m per unit of each unknown, [n]. state: u, u', q[1:], v[1:], a, z and a memory. Returns a Status.
    """
    n, nz, steps = size[0], size[2], size[3]
    A = tableau(size[4])
    s = len(A)
    q, v, a, z, zd = np.empty(n), np.empty(n), np.empty(n), np.empty(nz), np.empty(nz)
    q[0], v[0] = state[0], state[1]
    q[1:], v[1:] = state[2 : 1 + n], state[1 + n : 2 * n]
    a[:], z[:] = state[2 * n : 3 * n], state[3 * n : 3 * n + nz]
    padded, memory = n + size[1], state[3 * n + nz :]
    guess, meter = np.empty((2 * s, n)), memory[2:3]
    band, border, r, edge = np.empty((padded, 2 * size[1] + 1)), np.empty((2, n)), np.empty(padded), np.empty(padded)
    factored, guessed = recall(memory, guess, zd, band, border, edge)
    K, Kz, base, zb, before = np.empty((2, s, n)), np.empty((s, nz)), np.empty((3, n)), np.empty(nz), np.empty(nz)
    work = (r, band, border, edge, meter)
    total = steps * TICKS
    for i in range(out.shape[0]):
        position, width, euler = 0, TICKS, 0
        if meter[0] == 0.0:  # a start: its acceleration is what a short step finds
            width, euler = FIRST, 1
        while position < total:
            if euler == 0 and a[0] == 0.0:  # the step before ended in an impact
                width, euler, factored = max(width // 2, 1), 2, 0.0
            h, at = dt * width / total, (position + width) / total
            if euler == 0:
                same = guessed == width
                before[:] = z
                factored = step(
                    assemble, size, norm, c, A, drive, i, position / total, at, dt, q, v, a, z, zd, guess, same, K, Kz,
                    base, zb, work, factored,
                )  # fmt: skip
                if factored >= 0.0:
                    for m in range(s):
                        for j in range(n):
                            guess[m, j] = 2.0 * K[0, m, j] - guess[s + m, j] if same else K[0, m, j]
                            guess[s + m, j] = K[0, m, j]
                    guessed = float(width)
                    v[:], a[:], zd[:] = K[1, s - 1], K[0, s - 1], Kz[s - 1]
                else:
                    z[:] = before
            else:
                x, w = drive_at(drive, i, at, dt)
                for j in range(n):
                    K[1, 0, j] = v[j] + h * a[j]
                factored = newton(
                    assemble, size, norm, c, h, x, w, q, v, z, base[2], K[1, 0], K[0, 0], Kz[0], r, band, border, edge,
                    factored, TOLERANCE * TICKS / width, meter,
                )  # fmt: skip
                if factored >= 0.0:
                    jump = 0.0
                    for j in range(n):
                        jump = max(jump, norm[j] * h * abs(K[0, 0, j]))
                    for j in range(nz):
                        zd[j] = (Kz[0, j] - z[j]) / h
                    q[:], v[:], z[:], guessed = base[2], K[1, 0], Kz[0], 0.0
                    a[:] = K[0, 0]
                    if jump > IMPACT:
                        a[:] = 0.0
                    euler -= 1
            if factored < 0.0:
                if width == 1:
                    return 1
                width, euler, factored = width // 2, max(2 * euler, 2), 0.0
                a[:], guessed = 0.0, 0.0
                continue
            x, w = drive_at(drive, i, at, dt)
            assemble(SETTLE, c, h, x, w, q, v, a, z, z, r, band, border)
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
    keep(memory, guess, zd, band, border, edge, factored, guessed)
    return 0
