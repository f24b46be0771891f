"""One ANCF element: its constant matrices, its inertia, bending and axial forces and their derivative."""

from __future__ import annotations

from twin.kernels.fibre_ancf_layout import EI, EVEN, GAUSS, SHAPES
from twin.kernels.fibre_layout import DRAG, EA, FIBRE_MASS, GX, GY, LENGTH, TAU
from twin.kernels.jit import compiler, part

compiled = compiler("fibre")

_FAST = {"contract", "nsz"}


@compiled("void(float64[::1], float64, float64, boolean, float64[:,::1])", fastmath=_FAST)
def linear(c, length, g, derive, out):  # type: ignore[no-untyped-def]
    """Rows of an element's constant matrices: out[0:4] mass, out[4:8] bending, out[8:12] their part of the tangent."""
    m = c[FIBRE_MASS] / c[LENGTH] * length / 420.0
    k = c[EI] / length**3
    l, l2 = length, length * length
    mass = (156.0, 22.0 * l, 54.0, -13.0 * l, 4.0 * l2, 13.0 * l, -3.0 * l2)
    out[0, 0], out[0, 1], out[0, 2], out[0, 3] = m * mass[0], m * mass[1], m * mass[2], m * mass[3]
    out[1, 0], out[1, 1], out[1, 2], out[1, 3] = m * mass[1], m * mass[4], m * mass[5], m * mass[6]
    out[2, 0], out[2, 1], out[2, 2], out[2, 3] = m * mass[2], m * mass[5], m * mass[0], -m * mass[1]
    out[3, 0], out[3, 1], out[3, 2], out[3, 3] = m * mass[3], m * mass[6], -m * mass[1], m * mass[4]
    out[4, 0], out[4, 1], out[4, 2], out[4, 3] = 12.0 * k, 6.0 * k * l, -12.0 * k, 6.0 * k * l
    out[5, 0], out[5, 1], out[5, 2], out[5, 3] = 6.0 * k * l, 4.0 * k * l2, -6.0 * k * l, 2.0 * k * l2
    out[6, 0], out[6, 1], out[6, 2], out[6, 3] = -12.0 * k, -6.0 * k * l, 12.0 * k, -6.0 * k * l
    out[7, 0], out[7, 1], out[7, 2], out[7, 3] = 6.0 * k * l, 2.0 * k * l2, -6.0 * k * l, 4.0 * k * l2
    if derive:
        for i in range(4):
            for j in range(4):
                out[8 + i, j] = (1.0 / g + c[DRAG]) * out[i, j] + (g + c[TAU]) * out[4 + i, j]


@part(fastmath=_FAST)
def spread(k, d0, d1, d2, d3, bxx, bxy, byx, byy):  # type: ignore[no-untyped-def]
    """Add d_i d_j B to the 2 x 2 blocks (i, j) of k."""
    d = (d0, d1, d2, d3)
    for i in range(4):
        xx, xy, yx, yy = d[i] * bxx, d[i] * bxy, d[i] * byx, d[i] * byy
        for j in range(4):
            k[2 * i, 2 * j] += xx * d[j]
            k[2 * i, 2 * j + 1] += xy * d[j]
            k[2 * i + 1, 2 * j] += yx * d[j]
            k[2 * i + 1, 2 * j + 1] += yy * d[j]


@compiled(
    "void(float64[::1], float64, float64, boolean, float64[::1], float64[::1], float64[::1], float64[:,::1],"
    "float64[::1], float64[:,::1], float64[:,::1])",
    fastmath=_FAST,
)
def element(c, length, g, derive, q, v, a, lin, f, k, work):  # type: ignore[no-untyped-def]
    """One element's inertia, bending and axial forces f [8] and tangent k [8, 8]; q, v, a: its nodes', [8];
    work [5, 8]."""
    tau, drag = c[TAU], c[DRAG]
    m0, m1, m2, m3, m4, m5, m6 = lin[0, 0], lin[0, 1], lin[0, 2], lin[0, 3], lin[1, 1], lin[1, 2], lin[1, 3]
    k12, k6, k4, k2 = lin[4, 0], lin[4, 1], lin[5, 1], lin[5, 3]
    for x in range(2):
        gravity = c[GX] if x == 0 else c[GY]
        p0, p1 = a[x] + drag * v[x] - gravity, a[2 + x] + drag * v[2 + x]
        p2, p3 = a[4 + x] + drag * v[4 + x] - gravity, a[6 + x] + drag * v[6 + x]
        d = q[x] - q[4 + x] + tau * (v[x] - v[4 + x])
        s, t = q[2 + x] + tau * v[2 + x], q[6 + x] + tau * v[6 + x]
        push, bend = k12 * d + k6 * (s + t), k6 * d
        f[x] = (m0 * p0 + m1 * p1) + (m2 * p2 + m3 * p3) + push
        f[2 + x] = (m1 * p0 + m4 * p1) + (m5 * p2 + m6 * p3) + (bend + k4 * s + k2 * t)
        f[4 + x] = (m2 * p0 + m5 * p1) + (m0 * p2 - m1 * p3) - push
        f[6 + x] = (m3 * p0 + m6 * p1) + (m4 * p3 - m1 * p2) + (bend + k2 * s + k4 * t)
    if derive:
        for i in range(4):
            for j in range(4):
                k[2 * i, 2 * j] = k[2 * i + 1, 2 * j + 1] = lin[8 + i, j]
                k[2 * i, 2 * j + 1] = k[2 * i + 1, 2 * j] = 0.0
    at, inverse = int(c[SHAPES]), 1.0 / length
    mean = 0.0
    for i in range(GAUSS):  # work[i]: slopes of the shape functions, w r', the strain's derivative, the strain
        w, d0, d1, d3 = c[at], c[at + 1] * inverse, c[at + 2], c[at + 4]
        at += 5
        rx, ry = d0 * (q[0] - q[4]) + d1 * q[2] + d3 * q[6], d0 * (q[1] - q[5]) + d1 * q[3] + d3 * q[7]
        vx, vy = d0 * (v[0] - v[4]) + d1 * v[2] + d3 * v[6], d0 * (v[1] - v[5]) + d1 * v[3] + d3 * v[7]
        strain = 0.5 * (rx * rx + ry * ry - 1.0) + tau * (rx * vx + ry * vy)
        mean += w * strain
        work[i, 0], work[i, 1], work[i, 2], work[i, 3], work[i, 4] = d0, d1, d3, w * rx, w * ry
        work[i, 5], work[i, 6], work[i, 7] = (g + tau) * rx + g * tau * vx, (g + tau) * ry + g * tau * vy, strain
    whole, part = length * c[EA] * (1.0 - c[EVEN]), length * c[EA] * c[EVEN]
    for i in range(GAUSS):
        d0, d1, d3 = work[i, 0], work[i, 1], work[i, 2]
        force = whole * mean + part * work[i, 7]
        work[i, 7] = force
        sx, sy = force * work[i, 3], force * work[i, 4]
        f[0] += d0 * sx
        f[1] += d0 * sy
        f[2] += d1 * sx
        f[3] += d1 * sy
        f[4] -= d0 * sx
        f[5] -= d0 * sy
        f[6] += d3 * sx
        f[7] += d3 * sy
    if derive:
        work[3:5, :] = 0.0
        at = int(c[SHAPES])
        for i in range(GAUSS):
            w, d0, d1, d3 = c[at], work[i, 0], work[i, 1], work[i, 2]
            at += 5
            sx, sy, px, py = work[i, 3], work[i, 4], work[i, 5], work[i, 6]
            wx, wy = whole * w * px, whole * w * py
            for xy in range(2):
                s, t = (sx, wx) if xy == 0 else (sy, wy)
                work[3, xy] += d0 * s
                work[3, 2 + xy] += d1 * s
                work[3, 4 + xy] -= d0 * s
                work[3, 6 + xy] += d3 * s
                work[4, xy] += d0 * t
                work[4, 2 + xy] += d1 * t
                work[4, 4 + xy] -= d0 * t
                work[4, 6 + xy] += d3 * t
            tension = w * work[i, 7] * g
            sx, sy = part * sx, part * sy
            spread(k, d0, d1, -d0, d3, tension + sx * px, sx * py, sy * px, tension + sy * py)
        for i in range(8):
            for j in range(8):
                k[i, j] += work[3, i] * work[4, j]
