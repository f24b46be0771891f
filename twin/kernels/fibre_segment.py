"""Rigid finite elements joined by joint springs (Wittbrodt et al. 2006, chapter 2; Shabana 1997).

Segment i is a rigid rod with x, y, theta of its middle. The joint between two rods pulls their ends together with
EA / l and turns them with EI / l, l the distance of their middles, both with stiffness-proportional damping; the
fibre's ends are such joints too, without the torsion. Rods touch the rim at evenly spaced points (pressure k_n times
depth, bristles k_t that yield at mu times the pressure).
"""

from __future__ import annotations

import math

import numpy as np

from twin.kernels.fibre_layout import (
    DRAG,
    DTX,
    DTY,
    EA,
    FIBRE_MASS,
    GX,
    GY,
    LENGTH,
    MASS,
    RADIUS,
    RIM,
    SLIDING,
    TAU,
    WEIGHT,
)
from twin.kernels.fibre_rig import drive_end, guide, weight_end
from twin.kernels.fibre_segment_layout import BAND, CONTACT, EI, LENGTHS, POINTS, SEGMENTS, SHEAR
from twin.kernels.fibre_step import ASSEMBLE, GAUGE, RESIDUAL, SETTLE
from twin.kernels.jit import compiler, part

compiled = compiler("fibre")


@part
def rod_end(c, i, side, q, v, out):  # type: ignore[no-untyped-def]
    """End of rod i (side +1 or -1): out = x, y, their rates, their derivative over theta (2), and over it again (2)."""
    base, arm = 3 * i + 1, 0.5 * side * c[int(c[LENGTHS]) + i]
    cosine, sine = math.cos(q[base + 2]), math.sin(q[base + 2])
    out[4], out[5], out[6], out[7] = -arm * sine, arm * cosine, -arm * cosine, -arm * sine
    out[0], out[1] = q[base] + arm * cosine, q[base + 1] + arm * sine
    out[2], out[3] = v[base] + out[4] * v[base + 2], v[base + 1] + out[5] * v[base + 2]


@part
def rod_force(r, band, i, end, fx, fy, k, g, derive):  # type: ignore[no-untyped-def]
    """A spring k at an end of rod i that pulls it back with (fx, fy): balance and the rod's own block."""
    b = 3 * i + 1
    r[b] += fx
    r[b + 1] += fy
    r[b + 2] += end[4] * fx + end[5] * fy
    if derive:
        band[b, BAND] += k
        band[b + 1, BAND] += k
        band[b + 2, BAND] += k * (end[4] ** 2 + end[5] ** 2) + g * (end[6] * fx + end[7] * fy)
        band[b, BAND + 2] += k * end[4]
        band[b + 2, BAND - 2] += k * end[4]
        band[b + 1, BAND + 1] += k * end[5]
        band[b + 2, BAND - 1] += k * end[5]


@part
def joint(c, i, g, derive, q, v, one, two, r, band):  # type: ignore[no-untyped-def]
    """The joint between rods i and i + 1."""
    at = int(c[LENGTHS]) + i
    length = 0.5 * (c[at] + c[at + 1])
    tau, stiff, turn = c[TAU], c[EA] / length, c[EI] / length
    rod_end(c, i, 1.0, q, v, one)
    rod_end(c, i + 1, -1.0, q, v, two)
    fx = stiff * (two[0] - one[0] + tau * (two[2] - one[2]))
    fy = stiff * (two[1] - one[1] + tau * (two[3] - one[3]))
    k = stiff * (g + tau)
    rod_force(r, band, i, one, -fx, -fy, k, g, derive)
    rod_force(r, band, i + 1, two, fx, fy, k, g, derive)
    a, b = 3 * i + 1, 3 * i + 4
    moment = turn * (q[b + 2] - q[a + 2] + tau * (v[b + 2] - v[a + 2]))
    r[a + 2] -= moment
    r[b + 2] += moment
    if derive:
        bend = turn * (g + tau)
        band[a + 2, BAND] += bend
        band[b + 2, BAND] += bend
        cross = bend + k * (one[4] * two[4] + one[5] * two[5])
        band[a + 2, BAND + 3] -= cross
        band[b + 2, BAND - 3] -= cross
        for xy in range(2):
            band[a + xy, BAND + 3] -= k
            band[b + xy, BAND - 3] -= k
            band[a + xy, BAND + 5 - xy] -= k * two[4 + xy]
            band[b + 2, BAND - 5 + xy] -= k * two[4 + xy]
            band[a + 2, BAND + 1 + xy] -= k * one[4 + xy]
            band[b + xy, BAND - 1 - xy] -= k * one[4 + xy]


@part
def touch(c, i, g, derive, rim, q, v, zb, z, r, band, border):  # type: ignore[no-untyped-def]
    """Contact of rod i with the rim; the pulley's balance is the last of r."""
    base, points, radius = 3 * i + 1, int(c[POINTS]), c[RADIUS]
    length, s = c[int(c[LENGTHS]) + i], len(border[0]) - 1
    cosine, sine = math.cos(q[base + 2]), math.sin(q[base + 2])
    w = length / points
    kn, kt, mu = c[CONTACT] * w, c[SHEAR] * w, c[SLIDING]
    for p in range(points):
        at = points * i + p
        arm = length * ((p + 0.5) / points - 0.5)
        x, y = q[base] + arm * cosine, q[base + 1] + arm * sine
        jx, jy = -arm * sine, arm * cosine
        rho2 = x * x + y * y
        if rho2 >= radius * radius:
            z[at] = 0.0
            continue
        rho = math.sqrt(rho2)
        nx, ny = x / rho, y / rho
        tx, ty = ny, -nx
        lever = rho / radius
        push = kn * (radius - rho)
        slide = tx * (v[base] + jx * v[base + 2]) + ty * (v[base + 1] + jy * v[base + 2]) - rim * lever
        grip = kt * (zb[at] + g * slide)
        slips = abs(grip) > mu * push
        if slips:
            grip = math.copysign(mu * push, grip)
        z[at] = grip / kt if kt > 0.0 else 0.0
        fx, fy = -push * nx + grip * tx, -push * ny + grip * ty
        r[base] += fx
        r[base + 1] += fy
        r[base + 2] += jx * fx + jy * fy
        r[s] -= grip * lever
        if not derive:
            continue
        nn, tt, nt, tn = kn * g, -push * g / rho, -grip * g / rho, 0.0
        row_n, row_t = 0.0, 0.0
        if slips:
            tn = -math.copysign(mu * kn * g, grip)
            row_n = -tn * lever
        else:
            tt += kt * g
            row_t = -kt * g * lever
            border[0, s] += kt * g * lever * lever
        xx, xy = (
            nn * nx * nx + tt * tx * tx + (nt + tn) * nx * tx,
            nn * nx * ny + tt * tx * ty + nt * nx * ty + tn * tx * ny,
        )
        yx, yy = (
            nn * ny * nx + tt * ty * tx + nt * ny * tx + tn * ty * nx,
            nn * ny * ny + tt * ty * ty + (nt + tn) * ny * ty,
        )
        band[base, BAND] += xx
        band[base, BAND + 1] += xy
        band[base + 1, BAND - 1] += yx
        band[base + 1, BAND] += yy
        band[base, BAND + 2] += xx * jx + xy * jy
        band[base + 1, BAND + 1] += yx * jx + yy * jy
        band[base + 2, BAND - 2] += jx * xx + jy * yx
        band[base + 2, BAND - 1] += jx * xy + jy * yy
        band[base + 2, BAND] += jx * (xx * jx + xy * jy) + jy * (yx * jx + yy * jy)
        cx, cy = row_t * tx, row_t * ty
        rx, ry = row_n * nx + row_t * tx, row_n * ny + row_t * ty
        border[0, base] += cx
        border[0, base + 1] += cy
        border[0, base + 2] += jx * cx + jy * cy
        border[1, base] += rx
        border[1, base + 1] += ry
        border[1, base + 2] += jx * rx + jy * ry


@part
def pulled(c, x, w, q, v, end, g):  # type: ignore[no-untyped-def]
    """The drive's pull on the last rod: force and the stiffness of its joint."""
    last = int(c[SEGMENTS]) - 1
    px, py, vx, vy = drive_end(c, x, w)
    rod_end(c, last, 1.0, q, v, end)
    stiff = 2.0 * c[EA] / c[int(c[LENGTHS]) + last]
    fx, fy = stiff * (px - end[0] + c[TAU] * (vx - end[2])), stiff * (py - end[1] + c[TAU] * (vy - end[3]))
    return fx, fy, stiff * (g + c[TAU])


@compiled(ASSEMBLE)
def assemble(mode, c, g, x, w, q, v, a, zb, z, r, band, border):  # type: ignore[no-untyped-def]
    """M a - f and, if asked, its derivative over the stage's velocities; see `fibre_step`.

    Unknowns: u, then x, y, theta of every rod, s.
    """
    if mode == SETTLE:
        return 1
    derive = mode != RESIDUAL
    count, radius = int(c[SEGMENTS]), c[RADIUS]
    s, first = 3 * count + 1, int(c[LENGTHS])
    r[: s + 1] = 0.0
    r[s] = c[RIM] * a[s]
    if derive:
        band[:, :] = 0.0
        border[:, :] = 0.0
        border[0, s] = c[RIM] / g
    one, two = np.empty(8), np.empty(8)
    for i in range(count):
        base, length = 3 * i + 1, c[first + i]
        mass = c[FIBRE_MASS] / c[LENGTH] * length
        spin = mass * length * length / 12.0
        r[base] += mass * (a[base] + c[DRAG] * v[base] - c[GX])
        r[base + 1] += mass * (a[base + 1] + c[DRAG] * v[base + 1] - c[GY])
        r[base + 2] += spin * (a[base + 2] + c[DRAG] * v[base + 2])
        if derive:
            inertia = 1.0 / g + c[DRAG]
            band[base, BAND] += mass * inertia
            band[base + 1, BAND] += mass * inertia
            band[base + 2, BAND] += spin * inertia
        if i + 1 < count:
            joint(c, i, g, derive, q, v, one, two, r, band)
        reach = radius + length
        if radius > 0.0 and q[base] ** 2 + q[base + 1] ** 2 < reach * reach:
            touch(c, i, g, derive, v[s], q, v, zb, z, r, band, border)
        else:
            for p in range(int(c[POINTS]) * i, int(c[POINTS]) * (i + 1)):
                z[p] = 0.0
    px, py, dx, dy, bx, by = weight_end(c, q[0])
    rod_end(c, 0, -1.0, q, v, one)
    stiff = 2.0 * c[EA] / c[first]
    fx = stiff * (one[0] - px + c[TAU] * (one[2] - dx * v[0]))
    fy = stiff * (one[1] - py + c[TAU] * (one[3] - dy * v[0]))
    k = stiff * (g + c[TAU])
    rod_force(r, band, 0, one, fx, fy, k, g, derive)
    friction, slope = guide(c, q[0], v[0], math.hypot(fx, fy))
    r[0] += c[MASS] * a[0] + c[WEIGHT] + friction - fx * dx - fy * dy
    if derive:
        band[0, BAND] += c[MASS] / g + slope + k * (dx * dx + dy * dy) - g * (fx * bx + fy * by)
        turn = dx * one[4] + dy * one[5]
        band[0, BAND + 1] -= k * dx
        band[1, BAND - 1] -= k * dx
        band[0, BAND + 2] -= k * dy
        band[2, BAND - 2] -= k * dy
        band[0, BAND + 3] -= k * turn
        band[3, BAND - 3] -= k * turn
    fx, fy, k = pulled(c, x, w, q, v, two, g)
    rod_force(r, band, count - 1, two, -fx, -fy, k, g, derive)
    return 1


@compiled(GAUGE)
def gauge(c, x, w, q, v, z):  # type: ignore[no-untyped-def]
    """The pull of the last joint along the drive's axis, N."""
    fx, fy, _ = pulled(c, x, w, q, v, np.empty(8), 1.0)
    return fx * c[DTX] + fy * c[DTY]
