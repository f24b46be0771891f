# mypy: allow-untyped-defs, allow-untyped-calls
"""The force model's Taylor series over one step: every derivative of the motion from the balances themselves.

With y_n = y^(n) h^n / n! the balances turn into recursions, the tanh of the guide's friction by
y' = (1 - y^2) z' (Moore 1966; Jorba and Zou 2005, Taylor's method with variable order). A series that has not
converged is cut short by rescaling, at no further cost, and switches are roots of its polynomials.
"""

from __future__ import annotations

import math

from twin.kernels.force_layout import (
    B1,
    B2,
    C1,
    C2,
    DAMPING_SLOPE,
    DRY,
    DRY_SPEED,
    MASS,
    RATIO1,
    RATIO2,
    REST,
    RIM,
    STIFFNESS_SLOPE,
    THRESHOLD,
    TOLERANCE,
    WEIGHT,
)
from twin.kernels.jit import part

ORDER = 20
#: rows of the work array: motion, tension (whether it acts or not), drive, friction, threshold terms
U, V, S, W, P, Q, X, Y, R, G1, G2, ZD, E = range(13)
ROWS, COLUMNS = 14, ORDER + 2
#: the last row: sums at the step's end of U, V, S, W and, for U..Q, of the sizes of all terms but the first
SUM, SWING = 13, 4
#: laws of the guide's friction within a step
SMOOTH, SLIDING, CREEPING = 0, 1, 2


@part(fastmath={"contract", "reassoc"})
def next_tanh(C, n):
    """Term n + 1 of y = tanh z, from (n + 1) y_{n+1} = sum of (1 - y^2)_{n-j} (j + 1) z_{j+1}; places both."""
    total = 0.0
    for j in range(n + 1):
        total += C[R, n - j] * C[ZD, j]
    made = total / (n + 1)
    C[Y, n + 1] = made
    half, total = (n + 2) // 2, 0.0
    for j in range(half):
        total += C[Y, j] * C[Y, n + 1 - j]
    total *= 2.0
    if n % 2 == 1:
        total += C[Y, half] * C[Y, half]
    C[R, n + 1] = -total
    return made


@part(fastmath={"contract", "reassoc"})
def beyond_threshold(k, C, row, n, share, stretch, rate):
    """Term n of what S1's eq. 1 adds to a tension: (|u'| - v_tr) times (b_2 d' + c_2 d)."""
    C[row, n] = share * (k[DAMPING_SLOPE] * rate + k[STIFFNESS_SLOPE] * stretch)
    total = 0.0
    for j in range(n + 1):
        total += C[E, j] * C[row, n - j]
    return total


@part
def series(k, C, h, taut1, taut2, law, sign, fast, one):
    """Fills C with the series over h from C[U..W, 0] and the drive's C[X, 0..3]; returns terms and last size.

    sign: the direction of sliding. fast: that of u' beyond the threshold speed, or 0. one: 1, or 0 to leave out
    weight and rest tension (for a propagator's columns).
    """
    m, rim, c1, b1, c2, b2, dry = k[MASS], k[RIM], k[C1], k[B1], k[C2], k[B2], k[DRY]
    single, per_mass, per_h, tolerance = rim == 0.0, h / m, 1.0 / h, k[TOLERANCE]
    per_rim = 0.0 if single else h / rim
    drag, per_speed, rest, weight = per_mass * dry, 1.0 / k[DRY_SPEED], one * k[REST], one * k[WEIGHT]
    u, v, s, w = C[U, 0], C[V, 0], C[S, 0], C[W, 0]
    if law == SMOOTH:
        z = v * per_speed
        e = math.exp(-2.0 * abs(z))
        y = math.copysign((1.0 - e) / (1.0 + e), z)
        C[Y, 0], C[R, 0] = y, 4.0 * e / ((1.0 + e) * (1.0 + e))
    else:
        y = sign if law == SLIDING else v * per_speed
    sum_u, sum_v, sum_s, sum_w = u, v, s, w
    swing_u = swing_v = swing_s = swing_w = swing_p = swing_q = 0.0
    before = size = math.inf
    n = 0
    while n < ORDER:
        inverse = 1.0 / (n + 1)
        x, rate = (C[X, n], (n + 1) * C[X, n + 1] * per_h) if n < 4 else (0.0, 0.0)
        far, far_rate = (x, rate) if single else (s, w)
        p = c1 * (far - u) + b1 * (far_rate - v) + rest
        if fast != 0.0:
            C[E, n] = fast * v - (k[THRESHOLD] if n == 0 else 0.0)
            p += beyond_threshold(k, C, G1, n, k[RATIO1], far - u + rest / c1, far_rate - v)
        pull = p if taut1 != 0.0 else 0.0
        new_v = per_mass * inverse * (pull - weight) - drag * inverse * y
        new_u = h * inverse * v
        C[P, n], C[V, n + 1], C[U, n + 1] = p, new_v, new_u
        new_w = new_s = q = 0.0
        if not single:
            q = c2 * (x - s) + b2 * (rate - w) + rest
            if fast != 0.0:
                q += beyond_threshold(k, C, G2, n, k[RATIO2], x - s + rest / c2, rate - w)
            new_w = per_rim * inverse * ((q if taut2 != 0.0 else 0.0) - pull)
            new_s = h * inverse * w
            C[Q, n], C[W, n + 1], C[S, n + 1] = q, new_w, new_s
        if law == SMOOTH:
            C[ZD, n] = (n + 1) * new_v * per_speed
            y = next_tanh(C, n)
        else:
            y = 0.0 if law == SLIDING else new_v * per_speed
        if n > 0:
            swing_p += abs(p)
            swing_q += abs(q)
        u, v, s, w, rest, weight = new_u, new_v, new_s, new_w, 0.0, 0.0
        sum_u, sum_v, sum_s, sum_w = sum_u + u, sum_v + v, sum_s + s, sum_w + w
        swing_u, swing_v, swing_s, swing_w = swing_u + abs(u), swing_v + abs(v), swing_s + abs(s), swing_w + abs(w)
        before, size = size, abs(v) + abs(w) + drag * abs(y)
        n += 1
        if n > 3 and size < tolerance and before < tolerance:
            break
    C[SUM, 0], C[SUM, 1], C[SUM, 2], C[SUM, 3] = sum_u, sum_v, sum_s, sum_w
    C[SUM, SWING + U], C[SUM, SWING + V], C[SUM, SWING + S] = swing_u, swing_v, swing_s
    C[SUM, SWING + P], C[SUM, SWING + Q] = swing_p, swing_q
    return float(n), max(size, before)
