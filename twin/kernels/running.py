# mypy: allow-untyped-defs, allow-untyped-calls
"""Running sums for R(p), NRMSE and gain over a stream, with nothing lost after hours.

Each block is summed about a fixed shift, and the block's sums are added in pairs of floats (Knuth's two-sum), so
that rounding does not grow with time and what leaves a window is what once entered it.
"""

from __future__ import annotations

import math

from twin.kernels.jit import compiler, part

compiled = compiler("running")

#: places of the sums: a, b, a^2, b^2, ab, (b - a)^2; each is a pair (high, low)
SUMS = 6
COUNT, SHIFT_A, SHIFT_B, LOWEST, HIGHEST = 12, 13, 14, 15, 16
PLACES = 17


@part
def add(total, place, value):
    """total[place] += value, in a pair."""
    high, low = total[2 * place], total[2 * place + 1]
    s = high + value
    part = s - high
    low += (high - (s - part)) + (value - part)
    total[2 * place] = s + low
    total[2 * place + 1] = low - (total[2 * place] - s)


@part
def gather(total, a, b, begin, end, sign):
    """Adds (sign 1) or takes away (sign -1) the sums over a[begin:end], b[begin:end]."""
    sa = sb = saa = sbb = sab = see = 0.0
    for i in range(begin, end):
        p, q = a[i] - total[SHIFT_A], b[i] - total[SHIFT_B]
        e = b[i] - a[i]
        sa += p
        sb += q
        saa += p * p
        sbb += q * q
        sab += p * q
        see += e * e
    add(total, 0, sign * sa)
    add(total, 1, sign * sb)
    add(total, 2, sign * saa)
    add(total, 3, sign * sbb)
    add(total, 4, sign * sab)
    add(total, 5, sign * see)
    total[COUNT] += sign * (end - begin)


@part
def moment(total, square, first, second):
    """n times the covariance: a sum of products less the product of sums over n, both as pairs."""
    n = total[COUNT]
    p, q = total[2 * first], total[2 * second]
    head = total[2 * square] - p * q / n
    return head + total[2 * square + 1] - (p * total[2 * second + 1] + q * total[2 * first + 1]) / n


@compiled("f8(f8[::1])")
def correlation(total):
    """R of what is in the sums; NaN where either series does not move."""
    if total[COUNT] < 2.0:
        return math.nan
    va, vb, cab = moment(total, 2, 0, 0), moment(total, 3, 1, 1), moment(total, 4, 0, 1)
    if va <= 0.0 or vb <= 0.0:
        return math.nan
    return cab / math.sqrt(va * vb)


@compiled("f8(f8[::1], f8[::1], f8[::1])")
def push(total, a, b):
    """Takes a block of measured a and simulated b and returns R over everything so far."""
    n = len(a)
    if n == 0:
        return correlation(total)
    if total[COUNT] == 0.0:
        total[SHIFT_A], total[SHIFT_B] = a[0], b[0]
        total[LOWEST] = total[HIGHEST] = a[0]
    low, high = total[LOWEST], total[HIGHEST]
    for i in range(n):
        low, high = min(low, a[i]), max(high, a[i])
    total[LOWEST], total[HIGHEST] = low, high
    gather(total, a, b, 0, n, 1.0)
    return correlation(total)


@compiled("f8(f8[::1], f8[:, ::1], f8[::1], f8[::1], f8[::1])")
def slide(total, ring, place, a, b):
    """The same over the last len(ring[0]) samples; place[0] counts what was ever written to the ring.

    Once in a turn of the ring everything is summed afresh about the newest sample.
    """
    size = ring.shape[1]
    for i in range(len(a)):
        at = int(place[0]) % size
        if at == 0:
            ring[0, 0], ring[1, 0] = a[i], b[i]
            total[:] = 0.0
            total[SHIFT_A], total[SHIFT_B] = a[i], b[i]
            gather(total, ring[0], ring[1], 0, size if place[0] > 0.0 else 1, 1.0)
        else:
            if place[0] >= size:
                gather(total, ring[0], ring[1], at, at + 1, -1.0)
            ring[0, at], ring[1, at] = a[i], b[i]
            gather(total, ring[0], ring[1], at, at + 1, 1.0)
        place[0] += 1.0
    return correlation(total)
