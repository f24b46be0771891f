"""Planar gradient-deficient ANCF cable elements (Gerstmayr, Shabana 2006; Berzeri, Shabana 2000).

Cubic Hermite interpolation of positions and slopes; Green strain e = (r'.r' - 1)/2 with N = EA (e + tau e'), bending
energy EI |r''|^2 / 2 (exact to the order of the strain), both with stiffness-proportional damping, consistent mass.
Contact: at evenly spaced material points a pressure k_n * depth, and bristles k_t z that follow the rim's motion and
yield at mu times the pressure; z of every point is an inner variable. The pulley turns with J / r^2.
"""

from __future__ import annotations

import math

import numpy as np

from twin.kernels.fibre_ancf_element import element, linear, spread
from twin.kernels.fibre_ancf_layout import BAND, CONTACT, ELEMENTS, GAUSS, LENGTHS, POINTS, SHAPES, SHEAR
from twin.kernels.fibre_layout import (
    DTX,
    DTY,
    MASS,
    RADIUS,
    RIM,
    SLIDING,
    WEIGHT,
)
from twin.kernels.fibre_rig import drive_end, guide, weight_end
from twin.kernels.fibre_step import ASSEMBLE, GAUGE, RESIDUAL, SETTLE
from twin.kernels.jit import compiler, part

compiled = compiler("fibre")

_FAST = {"contract", "nsz"}


@part(fastmath=_FAST)
def contact(c, length, g, derive, rim, first, q, v, zb, z, f, k, edge):  # type: ignore[no-untyped-def]
    """One element's contact with the rim: adds to f, k and edge [2, 8] (column, row of the pulley).

    rim: the rim's speed. Returns the pulley's force and its derivative.
    """
    radius, points = c[RADIUS], int(c[POINTS])
    at = int(c[SHAPES]) + 5 * GAUSS
    w = length / points
    kn, kt, mu = c[CONTACT] * w, c[SHEAR] * w, c[SLIDING]
    torque, corner, inverse = 0.0, 0.0, 1.0 / radius
    for point in range(points):
        s0, s1, s2, s3 = c[at], c[at + 1] * length, c[at + 2], c[at + 3] * length
        at += 4
        x = s0 * q[0] + s1 * q[2] + s2 * q[4] + s3 * q[6]
        y = s0 * q[1] + s1 * q[3] + s2 * q[5] + s3 * q[7]
        rho2 = x * x + y * y
        if rho2 >= radius * radius:
            z[first + point] = 0.0
            continue
        rho = math.sqrt(rho2)
        per_rho, lever = 1.0 / rho, rho * inverse
        nx, ny = x * per_rho, y * per_rho
        tx, ty = ny, -nx
        push = kn * (radius - rho)
        slide = tx * (s0 * v[0] + s1 * v[2] + s2 * v[4] + s3 * v[6])
        slide += ty * (s0 * v[1] + s1 * v[3] + s2 * v[5] + s3 * v[7]) - rim * lever
        bristle = zb[first + point] + g * slide
        grip = kt * bristle
        slips = abs(grip) > mu * push
        if slips:
            grip = math.copysign(mu * push, grip)
            bristle = grip / kt if kt > 0.0 else 0.0
        z[first + point] = bristle
        fx, fy = -push * nx + grip * tx, -push * ny + grip * ty
        f[0] += s0 * fx
        f[1] += s0 * fy
        f[2] += s1 * fx
        f[3] += s1 * fy
        f[4] += s2 * fx
        f[5] += s2 * fy
        f[6] += s3 * fx
        f[7] += s3 * fy
        torque -= grip * lever
        if derive:
            nn, tt, nt = kn * g, -push * g * per_rho, -grip * g * per_rho
            tn = 0.0
            if slips:
                tn = -math.copysign(mu * kn * g, grip)
                row_n, row_t = -tn * lever, 0.0
                col = 0.0
            else:
                tt += kt * g
                col = -kt * g * lever
                row_n, row_t = 0.0, col
                corner += kt * g * lever**2
            spread(
                k,
                s0,
                s1,
                s2,
                s3,
                nn * nx * nx + tt * tx * tx + nt * nx * tx + tn * tx * nx,
                nn * nx * ny + tt * tx * ty + nt * nx * ty + tn * tx * ny,
                nn * ny * nx + tt * ty * tx + nt * ny * tx + tn * ty * nx,
                nn * ny * ny + tt * ty * ty + nt * ny * ty + tn * ty * ny,
            )
            d = (s0, s1, s2, s3)
            for i in range(4):
                edge[0, 2 * i] += d[i] * col * tx
                edge[0, 2 * i + 1] += d[i] * col * ty
                edge[1, 2 * i] += d[i] * (row_n * nx + row_t * tx)
                edge[1, 2 * i + 1] += d[i] * (row_n * ny + row_t * ty)
    return torque, corner


@part
def spread_out(c, x, w, q, v, a, elements, out):  # type: ignore[no-untyped-def]
    """Positions, velocities and accelerations of all nodes and slopes in a row, out [3, 4 (elements + 1)]."""
    end = 4 * elements
    px, py, dx, dy, _, _ = weight_end(c, q[0])
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = px, py, dx * v[0], dy * v[0]
    out[2, 0], out[2, 1] = dx * a[0], dy * a[0]
    for i in range(2, end):
        out[0, i], out[1, i], out[2, i] = q[i - 1], v[i - 1], a[i - 1]
    out[0, end], out[0, end + 1], out[1, end], out[1, end + 1] = drive_end(c, x, w)
    out[2, end] = out[2, end + 1] = 0.0
    for i in range(end + 2, end + 4):
        out[0, i], out[1, i], out[2, i] = q[i - 3], v[i - 3], a[i - 3]


@part(fastmath=_FAST)
def clear(q, length, radius):  # type: ignore[no-untyped-def]
    """True where an element cannot touch: its Bezier points lie beyond a tangent of the rim."""
    third = length / 3.0
    nx, ny = q[0] + q[4], q[1] + q[5]
    least = min(nx * q[0] + ny * q[1], nx * q[4] + ny * q[5])
    one = nx * (q[0] + third * q[2]) + ny * (q[1] + third * q[3])
    two = nx * (q[4] - third * q[6]) + ny * (q[5] - third * q[7])
    least = min(least, min(one, two))
    return least > 0.0 and least * least > radius * radius * (nx * nx + ny * ny)


@compiled(ASSEMBLE)
def assemble(mode, c, g, x, w, q, v, a, zb, z, r, band, border):  # type: ignore[no-untyped-def]
    """M a - f and, if asked, its derivative over the stage's velocities; see `fibre_step`.

    Unknowns: u, slope at the weight, position and slope of nodes 1 to N - 1, slope at the drive, s.
    """
    if mode == SETTLE:
        return 1
    derive = mode != RESIDUAL
    elements, radius, points = int(c[ELEMENTS]), c[RADIUS], int(c[POINTS])
    s = 4 * elements + 1
    r[: s + 1] = 0.0
    r[s] = c[RIM] * a[s]
    if derive:
        band[:, :] = 0.0
        border[:, :] = 0.0
        border[0, s] = c[RIM] / g
    _, _, dx, dy, cx, cy = weight_end(c, q[0])
    room = 12 * (elements + 1)
    space = np.empty(room + 176)
    full, f, lin = space[:room].reshape(3, -1), space[room : room + 8], space[room + 8 : room + 56].reshape(12, 4)
    k, edge = space[room + 56 : room + 120].reshape(8, 8), space[room + 120 : room + 136].reshape(2, 8)
    work = space[room + 136 :].reshape(5, 8)
    spread_out(c, x, w, q, v, a, elements, full)
    previous, pull, bend = -1.0, 0.0, 0.0
    for e in range(elements):
        length = c[int(c[LENGTHS]) + e]
        if length != previous:
            linear(c, length, g, derive, lin)
            previous = length
        here, speed = full[0, 4 * e : 4 * e + 8], full[1, 4 * e : 4 * e + 8]
        element(c, length, g, derive, here, speed, full[2, 4 * e : 4 * e + 8], lin, f, k, work)
        if e == 0:
            pull = math.hypot(f[0], f[1])
        touches = radius > 0.0 and not clear(here, length, radius)
        base = 4 * e - 1
        if touches:
            edge[:, :] = 0.0
            torque, corner = contact(c, length, g, derive, v[s], points * e, here, speed, zb, z, f, k, edge)
            r[s] += torque
            if derive and corner != 0.0:
                border[0, s] += corner
        else:
            for i in range(points * e, points * (e + 1)):
                z[i] = 0.0
        if 0 < e < elements - 1:
            for i in range(8):
                r[base + i] += f[i]
            if derive:
                for i in range(8):
                    for j in range(8):
                        band[base + i, BAND + j - i] += k[i, j]
                if touches:
                    for i in range(8):
                        border[0, base + i] += edge[0, i]
                        border[1, base + i] += edge[1, i]
            continue
        if e == 0:
            bend = g * (f[0] * cx + f[1] * cy)
        for i in range(8):
            row, scale = base + i, 1.0
            if e == 0 and i < 2:
                row, scale = 0, dx if i == 0 else dy
            elif e == 0 and i < 4:
                row = i - 1
            elif e == elements - 1 and i >= 4:
                if i < 6:
                    continue
                row = base + i - 2
            r[row] += scale * f[i]
            if not derive:
                continue
            if touches:
                border[0, row] += scale * edge[0, i]
                border[1, row] += scale * edge[1, i]
            for j in range(8):
                column, other = base + j, scale
                if e == 0 and j < 2:
                    column, other = 0, scale * (dx if j == 0 else dy)
                elif e == 0 and j < 4:
                    column = j - 1
                elif e == elements - 1 and j >= 4:
                    if j < 6:
                        continue
                    column = base + j - 2
                band[row, BAND + column - row] += other * k[i, j]
    friction, slope = guide(c, q[0], v[0], pull)
    r[0] += c[MASS] * a[0] + c[WEIGHT] + friction
    if derive:
        band[0, BAND] += c[MASS] / g + slope + bend
    return 1


@compiled(GAUGE)
def gauge(c, x, w, q, v, z):  # type: ignore[no-untyped-def]
    """The fibre's pull on the drive along the drive's axis, N (without the last node's own inertia)."""
    elements = int(c[ELEMENTS])
    e = elements - 1
    length = c[int(c[LENGTHS]) + e]
    full, lin = np.empty((3, 4 * elements + 4)), np.empty((12, 4))
    f, k, work = np.empty(8), np.empty((8, 8)), np.empty((5, 8))
    linear(c, length, 1.0, False, lin)
    spread_out(c, x, w, q, v, q, elements, full)
    full[2] = 0.0
    at = 4 * e
    element(c, length, 1.0, False, full[0, at:], full[1, at:], full[2, at:], lin, f, k, work)
    return f[4] * c[DTX] + f[5] * c[DTY]
