"""The point-mass chain: N free masses joined by unilateral spring-dampers, whose segments wrap the pulley.

A segment that would cut the pulley lies on it: two tangents and the arc between them, exact for a fibre without
bending stiffness, so that no mass need be on the arc. The fibre sticks to the rim at the arc's middle (through a
bond of finite length) until the tensions on its two sides reach the capstan ratio exp(mu phi). Inner variable z[0]:
the material coordinate at the middle plus the rim's displacement, constant while it sticks; z[1]: the segment there.
"""

from __future__ import annotations

import math

from twin.kernels.fibre_chain_layout import (
    BAND,
    BOND,
    CAPSTAN,
    COUNT,
    ONSET,
    POINT_MASS,
    RIM_LOSS,
    RIM_STIFFNESS,
    ROUND,
    SEGMENT,
    STIFFNESS,
)
from twin.kernels.fibre_layout import DRAG, EA, GX, GY, MASS, RADIUS, RIM, SLIDING, TAU, WEIGHT
from twin.kernels.fibre_rig import drive_end, guide, weight_end
from twin.kernels.fibre_step import ASSEMBLE, GAUGE, RESIDUAL, SETTLE
from twin.kernels.fibre_wrap import add, on_rim, settle, tangent, wraps
from twin.kernels.jit import compiler

compiled = compiler("fibre")


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
