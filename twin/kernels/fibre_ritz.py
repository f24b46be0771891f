"""Two strands of variable free length with polynomial modes (Du, Agrawal 2015, after S0 section 2).

A strand is stretched over its parameter p from 0 to 1; its material length L changes as the pulley, on which the fibre
does not slip, takes fibre from one strand to the other: L1 = N1 - s, L2 = N2 + s. Along its axis y(p) is linear
between the ends plus AXIAL bubbles, across it z(p) has TRANSVERSE bubbles. Strain e = sqrt(y'^2 + z'^2)/L - 1, tension
N = EA (e + tau e'), none in compression. The material moves through p at k(p) s'/L, k = p or 1 - p; Lagrange's
equations keep that in the mass matrix and leave out the products of speeds, which are of the order of the fibre's
mass per length times the speed squared (3 mN at 1 m/s).
"""

from __future__ import annotations

import math

import numpy as np

from twin.kernels.fibre_layout import (
    ALONG,
    DRAG,
    DRIVE_STRAND,
    DTX,
    DTY,
    EA,
    FIBRE_MASS,
    GX,
    GY,
    LENGTH,
    MASS,
    OFFSET,
    RADIUS,
    RIM,
    TAU,
    WEIGHT,
    WTX,
    WTY,
)
from twin.kernels.fibre_rig import guide, weight_end
from twin.kernels.fibre_ritz_layout import AXIAL, BAND, FIRST, GAUSS, MODES, ONSET, SECOND, TABLE, TRANSVERSE
from twin.kernels.fibre_step import ASSEMBLE, GAUGE, RESIDUAL, SETTLE
from twin.kernels.jit import compiler, part

compiled = compiler("fibre")


@part
def tension(c, e, rate):  # type: ignore[no-untyped-def]
    """N and its derivatives over e and its rate; damping sets in over the first micrometres of stretch."""
    if e <= 0.0:
        return 0.0, 0.0, 0.0
    ramp, steep = 1.0, 0.0
    if e < c[ONSET]:
        ramp, steep = e / c[ONSET], 1.0 / c[ONSET]
    force = c[EA] * (e + c[TAU] * ramp * rate)
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    return force, c[EA] * (1.0 + c[TAU] * steep * rate), c[EA] * c[TAU] * ramp


@part
def strand(c, first, near, length, sign, axis, normal, g, derive, q, v, a, end, end_rate, f, k, b, jy, jz):  # type: ignore[no-untyped-def]
    """One strand's forces f [9] and tangent k [9, 9] over (its end, AXIAL and TRANSVERSE modes, s).

    near: distance of its ends. length: of its material. sign: of d length / ds. axis, normal: gravity's parts.
    end: derivative of `near` over the end's unknown; end_rate: rate of `near` from a prescribed end.
    """
    f[:] = 0.0
    if derive:
        k[:, :] = 0.0
    density = c[FIBRE_MASS] / c[LENGTH]
    at = int(c[TABLE])
    for _ in range(GAUSS):
        p, w = c[at], c[at + 1] * length
        ys, zs, yr, zr = near, 0.0, end * v[0] + end_rate, 0.0
        for m in range(AXIAL):
            ys += c[at + 6 + m] * q[1 + m]
            yr += c[at + 6 + m] * v[1 + m]
        for m in range(TRANSVERSE):
            zs += c[at + 6 + m] * q[1 + AXIAL + m]
            zr += c[at + 6 + m] * v[1 + AXIAL + m]
        size = math.sqrt(ys * ys + zs * zs)
        strain = size / length - 1.0
        cy, cz = ys / (size * length), zs / (size * length)
        flow = (p if first else 1.0 - p) / length
        b[0], jy[0], jz[0] = cy * end, -end * (1.0 - p), 0.0
        b[8], jy[8], jz[8] = -sign * size / length**2, ys * flow, zs * flow
        for m in range(AXIAL):
            b[1 + m], jy[1 + m], jz[1 + m] = cy * c[at + 6 + m], c[at + 2 + m], 0.0
        for m in range(TRANSVERSE):
            i = 1 + AXIAL + m
            b[i], jy[i], jz[i] = cz * c[at + 6 + m], 0.0, c[at + 2 + m]
        rate = cy * yr + cz * zr + b[8] * v[8]
        force, stiff, damp = tension(c, strain, rate)
        ay, az = -axis, -normal
        if not first:
            ay += c[DRAG] * end_rate * p
        for i in range(9):
            ay += jy[i] * (a[i] + c[DRAG] * v[i])
            az += jz[i] * (a[i] + c[DRAG] * v[i])
        for i in range(9):
            f[i] += w * (force * b[i] + density * (jy[i] * ay + jz[i] * az))
        if derive:
            inertia, slope = density * (1.0 / g + c[DRAG]), g * stiff + damp
            for i in range(9):
                for j in range(9):
                    k[i, j] += w * (slope * b[i] * b[j] + inertia * (jy[i] * jy[j] + jz[i] * jz[j]))
            bend = w * g * force / (size * length)
            for i in range(TRANSVERSE):
                for j in range(TRANSVERSE):
                    k[1 + AXIAL + i, 1 + AXIAL + j] += bend * c[at + 6 + i] * c[at + 6 + j]
        at += 10


@part
def take(q, base, first, s, out):  # type: ignore[no-untyped-def]
    """A strand's nine unknowns out of all."""
    out[0] = q[0] if first else 0.0
    for m in range(MODES):
        out[1 + m] = q[base + m]
    out[8] = q[s]


@part
def give(base, first, s, derive, f, k, r, band, border):  # type: ignore[no-untyped-def]
    """Add a strand's forces and tangent to all."""
    r[s] += f[8]
    if derive:
        border[0, s] += k[8, 8]
    for i in range(0 if first else 1, 8):
        row = 0 if i == 0 else base + i - 1
        r[row] += f[i]
        if derive:
            border[0, row] += k[i, 8]
            border[1, row] += k[8, i]
            for j in range(0 if first else 1, 8):
                column = 0 if j == 0 else base + j - 1
                band[row, BAND + column - row] += k[i, j]


@part
def distance(c, u):  # type: ignore[no-untyped-def]
    """From the weight to the pulley's tangent point, m."""
    return math.hypot(c[ALONG] - u, c[OFFSET])


@compiled(ASSEMBLE)
def assemble(mode, c, g, x, w, q, v, a, zb, z, r, band, border):  # type: ignore[no-untyped-def]
    """M a - f and, if asked, its derivative over the stage's velocities; see `fibre_step`.

    Unknowns: u, the weight strand's modes, the drive strand's modes, s.
    """
    if mode == SETTLE:
        return 1
    derive = mode != RESIDUAL
    s = 1 + 2 * MODES
    r[: s + 1] = 0.0
    r[s] = c[RIM] * a[s]
    if derive:
        band[:, :] = 0.0
        border[:, :] = 0.0
        border[0, s] = c[RIM] / g
    one, two, three, f, k = np.empty(9), np.empty(9), np.empty(9), np.empty(9), np.empty((9, 9))
    b, jy, jz = np.empty(9), np.empty(9), np.empty(9)
    _, _, dx, dy, _, _ = weight_end(c, q[0])
    cosine = dx * c[WTX] + dy * c[WTY]
    near = distance(c, q[0])
    pulley = c[RADIUS] > 0.0
    length = c[FIRST] - (q[s] if pulley else 0.0)
    if length <= 0.0 or (c[SECOND] + q[s] <= 0.0 and pulley):
        return 0
    take(q, 1, True, s, one)
    take(v, 1, True, s, two)
    take(a, 1, True, s, three)
    sign = -1.0 if pulley else 0.0
    axis, normal = c[GX] * c[WTX] + c[GY] * c[WTY], c[GY] * c[WTX] - c[GX] * c[WTY]
    strand(c, True, near, length, sign, axis, normal, g, derive, one, two, three, -cosine, 0.0, f, k, b, jy, jz)
    pull = f[0]
    give(1, True, s, derive, f, k, r, band, border)
    base = 1 + MODES
    if pulley:
        take(q, base, False, s, one)
        take(v, base, False, s, two)
        take(a, base, False, s, three)
        axis, normal = c[GX] * c[DTX] + c[GY] * c[DTY], c[GY] * c[DTX] - c[GX] * c[DTY]
        far, length = c[DRIVE_STRAND] + x, c[SECOND] + q[s]
        strand(c, False, far, length, 1.0, axis, normal, g, derive, one, two, three, 0.0, w, f, k, b, jy, jz)
        give(base, False, s, derive, f, k, r, band, border)
    else:
        for i in range(base, s):
            r[i] = a[i]
            if derive:
                band[i, BAND] = 1.0 / g
    friction, slope = guide(c, q[0], v[0], abs(pull))
    r[0] += c[MASS] * a[0] + c[WEIGHT] + friction
    if derive:
        band[0, BAND] += c[MASS] / g + slope
    return 1


@compiled(GAUGE)
def gauge(c, x, w, q, v, z):  # type: ignore[no-untyped-def]
    """What the strand at the gauge does against a displacement of its end, along its axis, N."""
    s = 1 + 2 * MODES
    if c[RADIUS] > 0.0:
        base, ys, yr, length, taken = 1 + MODES, c[DRIVE_STRAND] + x, w, c[SECOND] + q[s], v[s]
    else:
        _, _, dx, dy, _, _ = weight_end(c, q[0])
        base, ys, yr = 1, distance(c, q[0]), -(dx * c[WTX] + dy * c[WTY]) * v[0]
        length, taken = c[FIRST], 0.0
    total, at = 0.0, int(c[TABLE])
    for _ in range(GAUSS):
        py, pr, zs, zr = ys, yr, 0.0, 0.0
        for m in range(TRANSVERSE):
            slope = c[at + 6 + m]
            if m < AXIAL:
                py += slope * q[base + m]
                pr += slope * v[base + m]
            zs += slope * q[base + AXIAL + m]
            zr += slope * v[base + AXIAL + m]
        size = math.sqrt(py * py + zs * zs)
        rate = (py * pr + zs * zr) / (size * length) - size * taken / length**2
        force, _, _ = tension(c, size / length - 1.0, rate)
        total += c[at + 1] * force * py / size
        at += 10
    return total
