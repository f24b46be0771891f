"""The point-mass chain: N free masses joined by unilateral spring-dampers, whose segments wrap the pulley.

A segment that would cut the pulley lies on it: two tangents and the arc between them, exact for a fibre without
bending stiffness, so that no mass need be on the arc. The fibre sticks to the rim at the arc's middle (through a
bond of finite length) until the tensions on its two sides reach the capstan ratio exp(mu phi). Inner variable z[0]:
the material coordinate at the middle plus the rim's displacement, constant while it sticks; z[1]: the segment there.
"""

from __future__ import annotations

import math

from twin.kernels.fibre_layout import DRAG, EA, GX, GY, MASS, RADIUS, RIG, RIM, SLIDING, TAU, WEIGHT
from twin.kernels.fibre_rig import drive_end, guide, weight_end
from twin.kernels.fibre_step import ASSEMBLE, GAUGE, RESIDUAL, SETTLE
from twin.kernels.jit import compiler, part

compiled = compiler("fibre")

# the model's own constants
COUNT, POINT_MASS, SEGMENT, STIFFNESS, ROUND, RIM_STIFFNESS, BOND, ONSET, CAPSTAN, STEP, RIM_LOSS = range(RIG, RIG + 11)
OWN = 11
BAND = 3
HYSTERESIS = 5e-5  # m, of the handover between segments


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


@compiled(ASSEMBLE)
def assemble(mode, c, g, x, w, q, v, a, zb, z, r, band, border):  # type: ignore[no-untyped-def]
    """M a - f and, if asked, its derivative over the stage's velocities; see `fibre_step`."""
    if mode == SETTLE:
        if c[RADIUS] > 0.0:
            settle(c, x, w, q, z)
        return 1
    derive = mode != RESIDUAL
    count, radius, natural = int(c[COUNT]), c[RADIUS], c[SEGMENT]
    n = 2 * count + 2
    s = n - 1
    pm = c[POINT_MASS]
    z[0], z[1] = zb[0], zb[1]
    split = int(zb[1])
    for i in range(1, s, 2):
        r[i] = pm * (a[i] + c[DRAG] * v[i] - c[GX])
        r[i + 1] = pm * (a[i + 1] + c[DRAG] * v[i + 1] - c[GY])
    r[s] = c[RIM] * a[s]
    if derive:
        band[:, :] = 0.0
        border[:, :] = 0.0
        for i in range(1, s):
            band[i, BAND] = pm * (1.0 / g + c[DRAG])
        border[0, s] = c[RIM] / g
    ax, ay, wx, wy, bx_, by_ = weight_end(c, q[0])
    first_x, first_y, curve_x, curve_y = wx, wy, bx_, by_
    avx, avy = wx * v[0], wy * v[0]
    sax, say, jar, jat, jab = on_rim(c, ax, ay)
    weight_force, weight_slope = 0.0, 0.0
    for j in range(count + 1):
        if j < count:
            i = 2 * j + 1
            bx, by, bvx, bvy = q[i], q[i + 1], v[i], v[i + 1]
        else:
            bx, by, bvx, bvy = drive_end(c, x, w)
        sbx, sby, jbr, jbt, jbb = on_rim(c, bx, by)
        wrapped = wraps(radius, sax, say, sbx, sby)
        if wrapped:
            la, gax, gay, ca = tangent(radius, sax, say, 1.0)
            lb, gbx, gby, cb = tangent(radius, sbx, sby, -1.0)
        else:
            dx, dy = sbx - sax, sby - say
            length = math.sqrt(dx * dx + dy * dy)
            gbx, gby = dx / length, dy / length
            gax, gay = -gbx, -gby
            la, lb, ca, cb = length, 0.0, 1.0 / length, 1.0 / length
        hax, hay, hbx, hby = -gay, gax, -gby, gbx  # normals, of the fibre's direction at its ends
        bend_a, bend_b = 0.0, 0.0
        if jar != 1.0:
            ux, uy = sax / math.hypot(sax, say), say / math.hypot(sax, say)
            radial, cross = gax * ux + gay * uy, gay * ux - gax * uy
            gax, gay = jar * radial * ux - jat * cross * uy, jar * radial * uy + jat * cross * ux
            bend_a = radial * jab
            radial, cross = hax * ux + hay * uy, hay * ux - hax * uy
            hax, hay = jar * radial * ux - jat * cross * uy, jar * radial * uy + jat * cross * ux
        if jbr != 1.0:
            ux, uy = sbx / math.hypot(sbx, sby), sby / math.hypot(sbx, sby)
            radial, cross = gbx * ux + gby * uy, gby * ux - gbx * uy
            gbx, gby = jbr * radial * ux - jbt * cross * uy, jbr * radial * uy + jbt * cross * ux
            bend_b = radial * jbb
            radial, cross = hbx * ux + hby * uy, hby * ux - hbx * uy
            hbx, hby = jbr * radial * ux - jbt * cross * uy, jbr * radial * uy + jbt * cross * ux
        rate_a, rate_b = gax * avx + gay * avy, gbx * bvx + gby * bvy
        stretch = la + lb - natural
        ta, tb, kaa, kab, kba, kbb = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        sticks = wrapped and j == split and c[SLIDING] > 0.0
        if stretch > 0.0:
            ramp, steep = 1.0, 0.0
            if stretch < c[ONSET]:
                ramp, steep = stretch / c[ONSET], 1.0 / c[ONSET]
            damp = c[TAU] * ramp
            if not sticks:
                k = c[STIFFNESS]
                rate = rate_a + rate_b
                ta = k * (stretch + damp * rate)
                if ta > 0.0:
                    kaa = k * (g * (1.0 + c[TAU] * steep * rate) + damp)
                else:
                    ta = 0.0
                tb, kab, kba, kbb = ta, kaa, kaa, kaa
            else:
                l1 = zb[0] - q[s] - split * natural
                l2 = natural - l1
                k1, k2 = c[EA] / (max(l1, 0.0) + c[BOND]), c[EA] / (max(l2, 0.0) + c[BOND])
                p1, p2 = k1 * (g + damp), k2 * (g + damp)
                ra, rb = rate_a + v[s], rate_b - v[s]
                ta, tb = k1 * (la - l1 + damp * ra), k2 * (lb - l2 + damp * rb)
                d1, d2 = k1 * c[TAU] * steep * ra * g, k2 * c[TAU] * steep * rb * g
                ratio = c[CAPSTAN]
                kaa, kab, kba, kbb = p1 + d1, d1, d2, p2 + d2
                f1, f2 = p1 / g, p2 / g
                slip = 0.0
                if ta > ratio * tb:
                    slip = (ta - ratio * tb) / (f1 + ratio * f2)
                    ha, hb = 1.0 / (f1 + ratio * f2), -ratio / (f1 + ratio * f2)
                elif tb > ratio * ta:
                    slip = -(tb - ratio * ta) / (f2 + ratio * f1)
                    ha, hb = ratio / (f2 + ratio * f1), -1.0 / (f2 + ratio * f1)
                if slip != 0.0:
                    z[0] = zb[0] + slip
                    ta -= f1 * slip
                    tb += f2 * slip
                    da, db = ha * kaa + hb * kba, ha * kab + hb * kbb
                    kaa, kab = kaa - f1 * da, kab - f1 * db
                    kba, kbb = kba + f2 * da, kbb + f2 * db
                if ta <= 0.0 or tb <= 0.0:
                    ta, tb, kaa, kab, kba, kbb = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
                r[s] += ta - tb
        if j == 0:
            weight_force = ta
            fx, fy = ta * gax, ta * gay
            r[0] = fx * first_x + fy * first_y
            weight_slope = g * (fx * curve_x + fy * curve_y)
        else:
            r[2 * j - 1] += ta * gax
            r[2 * j] += ta * gay
        if j < count:
            r[2 * j + 1] += tb * gbx
            r[2 * j + 2] += tb * gby
        if derive and ta > 0.0:
            ga, gb = g * ta * ca, g * tb * cb
            # A with A
            xx, xy, yy = (
                kaa * gax * gax + ga * hax * hax,
                kaa * gax * gay + ga * hax * hay,
                kaa * gay * gay + ga * hay * hay,
            )
            if bend_a != 0.0:
                ux, uy = sax / math.hypot(sax, say), say / math.hypot(sax, say)
                e = g * ta * bend_a
                xx, xy, yy = xx + e * ux * ux, xy + e * ux * uy, yy + e * uy * uy
            cross_g = 0.0 if wrapped else -1.0
            abx, aby = kab * gax, kab * gay
            if j == 0:
                band[0, BAND] += first_x * (xx * first_x + xy * first_y) + first_y * (xy * first_x + yy * first_y)
                if j < count:
                    gu, hu = gax * first_x + gay * first_y, hax * first_x + hay * first_y
                    ge = -cross_g * ga * hu
                    band[0, BAND + 1] += kab * gu * gbx + ge * hbx
                    band[0, BAND + 2] += kab * gu * gby + ge * hby
                    band[1, BAND - 1] += kba * gu * gbx + ge * hbx
                    band[2, BAND - 2] += kba * gu * gby + ge * hby
            else:
                ia = 2 * j - 1
                add(band, ia, ia, xx, xy, xy, yy)
                if j < count:
                    ib, ge = ia + 2, -cross_g * ga
                    add(
                        band,
                        ia,
                        ib,
                        abx * gbx + ge * hax * hbx,
                        abx * gby + ge * hax * hby,
                        aby * gbx + ge * hay * hbx,
                        aby * gby + ge * hay * hby,
                    )
                    bax, bay = kba * gbx, kba * gby
                    add(
                        band,
                        ib,
                        ia,
                        bax * gax + ge * hbx * hax,
                        bax * gay + ge * hbx * hay,
                        bay * gax + ge * hby * hax,
                        bay * gay + ge * hby * hay,
                    )
            if j < count:
                ib = 2 * j + 1
                xx, xy, yy = (
                    kbb * gbx * gbx + gb * hbx * hbx,
                    kbb * gbx * gby + gb * hbx * hby,
                    kbb * gby * gby + gb * hby * hby,
                )
                if bend_b != 0.0:
                    ux, uy = sbx / math.hypot(sbx, sby), sby / math.hypot(sbx, sby)
                    e = g * tb * bend_b
                    xx, xy, yy = xx + e * ux * ux, xy + e * ux * uy, yy + e * uy * uy
                add(band, ib, ib, xx, xy, xy, yy)
            if sticks:
                sa, sb = kaa - kab, kba - kbb
                border[0, s] += sa - sb
                if j == 0:
                    gu = gax * first_x + gay * first_y
                    border[0, 0] += sa * gu
                    border[1, 0] += (kaa - kba) * gu
                else:
                    border[0, 2 * j - 1] += sa * gax
                    border[0, 2 * j] += sa * gay
                    border[1, 2 * j - 1] += (kaa - kba) * gax
                    border[1, 2 * j] += (kaa - kba) * gay
                if j < count:
                    border[0, 2 * j + 1] += sb * gbx
                    border[0, 2 * j + 2] += sb * gby
                    border[1, 2 * j + 1] += (kab - kbb) * gbx
                    border[1, 2 * j + 2] += (kab - kbb) * gby
        if j < count and radius > 0.0:
            rho2 = bx * bx + by * by
            if rho2 < (radius - c[ROUND]) ** 2:
                rho = math.sqrt(rho2)
                ux, uy = bx / rho, by / rho
                depth = radius - c[ROUND] - rho
                loss = max(1.0 - c[RIM_LOSS] * (bvx * ux + bvy * uy), 0.0)
                push = c[RIM_STIFFNESS] * depth * loss
                r[2 * j + 1] -= push * ux
                r[2 * j + 2] -= push * uy
                if derive and loss > 0.0:
                    k = c[RIM_STIFFNESS] * (g * loss + depth * c[RIM_LOSS])
                    add(band, 2 * j + 1, 2 * j + 1, k * ux * ux, k * ux * uy, k * ux * uy, k * uy * uy)
        ax, ay, avx, avy = bx, by, bvx, bvy
        sax, say, jar, jat, jab = sbx, sby, jbr, jbt, jbb
    friction, slope = guide(c, q[0], v[0], weight_force)
    r[0] += c[MASS] * a[0] + c[WEIGHT] + friction
    if derive:
        band[0, BAND] += c[MASS] / g + slope + weight_slope
    return 1


@compiled(GAUGE)
def gauge(c, x, w, q, v, z):  # type: ignore[no-untyped-def]
    """The last segment's tension along the drive's axis, N."""
    count = int(c[COUNT])
    bx, by, bvx, bvy = drive_end(c, x, w)
    ax, ay = q[2 * count - 1], q[2 * count]
    dx, dy = bx - ax, by - ay
    length = math.sqrt(dx * dx + dy * dy)
    stretch = length - c[SEGMENT]
    if stretch <= 0.0:
        return 0.0
    rate = (dx * (bvx - v[2 * count - 1]) + dy * (bvy - v[2 * count])) / length
    return max(0.0, c[STIFFNESS] * (stretch + c[TAU] * min(1.0, stretch / c[ONSET]) * rate))
