"""How a segment of the point-mass chain lies on the pulley: on it or not, its tangents, where it sticks."""

from __future__ import annotations

import math

from twin.kernels.fibre_chain_layout import BAND, BOND, COUNT, HYSTERESIS, ROUND, SEGMENT
from twin.kernels.fibre_layout import RADIUS
from twin.kernels.fibre_rig import drive_end, weight_end
from twin.kernels.jit import part


@part
def on_rim(c, x, y):  # type: ignore[no-untyped-def]
    """A point as the fibre sees it: pushed out of the pulley with a rounded edge: x, y, J radial, J tangential, J'."""
    radius, edge = c[RADIUS], c[ROUND]
    square = x * x + y * y
    if square >= (radius + edge) ** 2 or radius == 0.0:
        return x, y, 1.0, 1.0, 0.0
    rho = math.sqrt(square)
    gap = rho - radius
    out, slope, bend = 0.0, 0.0, 0.0
    if gap > -edge:
        out, slope, bend = (gap + edge) ** 2 / (4.0 * edge), (gap + edge) / (2.0 * edge), 0.5 / edge
    scale = (radius + out) / rho
    return x * scale, y * scale, slope, scale, bend


@part
def wraps(radius, ax, ay, bx, by):  # type: ignore[no-untyped-def]
    """Does the segment from A to B, clockwise over the top, lie on the pulley?"""
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    along = -(ax * dx + ay * dy)
    if radius == 0.0 or along <= 0.0 or along >= square:
        return False
    cross = ax * by - ay * bx
    return cross > 0.0 or cross * cross < radius * radius * square


@part
def tangent(radius, x, y, side):  # type: ignore[no-untyped-def]
    """The free end of a wrapped segment: length to the arc's middle, its gradient, 1 / tangent length.

    side: +1 for the end towards the weight, -1 towards the drive.
    """
    rho2 = x * x + y * y
    rho = math.sqrt(rho2)
    free = math.sqrt(max((rho - radius) * (rho + radius), 0.0))
    angle = math.atan2(y, x)
    if angle < -0.5 * math.pi:
        angle += 2.0 * math.pi
    length = free - radius * math.atan2(free, radius) + side * radius * (angle - 0.5 * math.pi)
    gx = (free * x - side * radius * y) / rho2
    gy = (free * y + side * radius * x) / rho2
    return length, gx, gy, (1.0 / free if free > 1e-10 else 0.0)


@part
def add(band, i, j, xx, xy, yx, yy):  # type: ignore[no-untyped-def]
    """Add a 2 x 2 block at (i, j)."""
    band[i, BAND + j - i] += xx
    band[i, BAND + j + 1 - i] += xy
    band[i + 1, BAND + j - i - 1] += yx
    band[i + 1, BAND + j - i] += yy


@part
def node(c, j, q, x, w):  # type: ignore[no-untyped-def]
    """Position of node j: 0 the weight's end, N + 1 the drive's."""
    if j == 0:
        px, py, _, _, _, _ = weight_end(c, q[0])
        return px, py
    if j == int(c[COUNT]) + 1:
        px, py, _, _ = drive_end(c, x, w)
        return px, py
    return q[2 * j - 1], q[2 * j]


@part
def settle(c, x, w, q, z):  # type: ignore[no-untyped-def]
    """After a step: which segment lies on the arc's middle, and where on it, if that changed or the fibre is slack."""
    count, natural = int(c[COUNT]), c[SEGMENT]
    m = int(z[1])
    ax, ay = node(c, m, q, x, w)
    bx, by = node(c, m + 1, q, x, w)
    moved = False
    while m < count and bx < -HYSTERESIS:
        m, moved, ax, ay = m + 1, True, bx, by
        bx, by = node(c, m + 1, q, x, w)
    while m > 0 and ax > HYSTERESIS:
        m, moved, bx, by = m - 1, True, ax, ay
        ax, ay = node(c, m, q, x, w)
    sx, sy, _, _, _ = on_rim(c, ax, ay)
    tx, ty, _, _, _ = on_rim(c, bx, by)
    if not wraps(c[RADIUS], sx, sy, tx, ty):
        dx, dy = tx - sx, ty - sy
        part = min(max(-(sx * dx + sy * dy) / (dx * dx + dy * dy), 0.0), 1.0)
        z[0], z[1] = (m + part) * natural + q[-1], float(m)
        return
    first, _, _, _ = tangent(c[RADIUS], sx, sy, 1.0)
    second, _, _, _ = tangent(c[RADIUS], tx, ty, -1.0)
    stretch = first + second - natural
    if not moved and stretch > 0.0:
        return
    difference = 0.0
    if moved and stretch > 0.0:
        px, py = node(c, int(z[1]), q, x, w)
        rx, ry = node(c, int(z[1]) + 1, q, x, w)
        px, py, _, _, _ = on_rim(c, px, py)
        rx, ry, _, _, _ = on_rim(c, rx, ry)
        one, _, _, _ = tangent(c[RADIUS], px, py, 1.0)
        two, _, _, _ = tangent(c[RADIUS], rx, ry, -1.0)
        l1 = z[0] - q[-1] - z[1] * natural
        l2 = natural - l1
        difference = (one - l1) / (max(l1, 0.0) + c[BOND]) - (two - l2) / (max(l2, 0.0) + c[BOND])
        difference = min(max(difference, -stretch / natural), stretch / natural)
    la, lb = max(first, 0.0) + c[BOND], max(second, 0.0) + c[BOND]
    part = (difference + stretch / lb) / (1.0 / la + 1.0 / lb)
    z[0], z[1] = m * natural + first - part + q[-1], float(m)
