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
from twin.kernels.jit import compiler

compiled = compiler("force")

ORDER = 20
#: rows of the work array: motion, tension (whether it acts or not), drive, friction, threshold terms
U, V, S, W, P, Q, X, Y, R, G1, G2, ZD, E = range(13)
ROWS, COLUMNS = 13, ORDER + 2
#: laws of the guide's friction within a step
SMOOTH, SLIDING, CREEPING = 0, 1, 2


@compiled("void(f8[::1], f8[:, ::1], i8, f8)")
def begin_friction(k, C, law, sign):
    """Places tanh(v/v_s) and its slope at the step's start; sign: the direction of motion where it slides."""
    z = C[V, 0] / k[DRY_SPEED]
    if law == SLIDING:
        C[Y, 0] = sign
    elif law == CREEPING:
        C[Y, 0] = z
    else:
        e = math.exp(-2.0 * abs(z))
        C[Y, 0] = math.copysign((1.0 - e) / (1.0 + e), z)
        C[R, 0] = 4.0 * e / ((1.0 + e) * (1.0 + e))


@compiled("void(f8[::1], f8[:, ::1], i8, i8)", fastmath={"contract", "reassoc"})
def next_friction(k, C, law, n):
    """Places term n + 1 of tanh(v/v_s)."""
    if law == SLIDING:
        C[Y, n + 1] = 0.0
        return
    if law == CREEPING:
        C[Y, n + 1] = C[V, n + 1] / k[DRY_SPEED]
        return
    C[ZD, n] = (n + 1) * C[V, n + 1] / k[DRY_SPEED]
    total = 0.0
    for j in range(n + 1):
        total += C[R, n - j] * C[ZD, j]
    C[Y, n + 1] = total / (n + 1)
    total = 0.0
    for j in range(n + 2):
        total += C[Y, j] * C[Y, n + 1 - j]
    C[R, n + 1] = -total


@compiled("f8(f8[:, ::1], i8, i8)", fastmath={"contract", "reassoc"})
def beyond_threshold(C, row, n):
    """Term n of (|u'| - v_tr) times the row's series: what the speed beyond the threshold adds to a tension."""
    total = 0.0
    for j in range(n + 1):
        total += C[E, j] * C[row, n - j]
    return total


@compiled("f8(f8[::1], f8[:, ::1], f8, i8, f8, f8, i8)")
def first_tension(k, C, h, n, fast, one, single):
    """Term n of the weight strand's tension, S1's form beyond the threshold where fast is not 0."""
    if single:
        stretch = C[X, n] - C[U, n]
        rate = (n + 1) * C[X, n + 1] / h - C[V, n]
    else:
        stretch, rate = C[S, n] - C[U, n], C[W, n] - C[V, n]
    rest = one * k[REST] if n == 0 else 0.0
    tension = k[C1] * stretch + k[B1] * rate + rest
    if fast != 0.0:
        C[G1, n] = k[RATIO1] * (k[DAMPING_SLOPE] * rate + k[STIFFNESS_SLOPE] * (stretch + rest / k[C1]))
        tension += beyond_threshold(C, G1, n)
    return tension


@compiled("f8(f8[::1], f8[:, ::1], f8, i8, f8, f8)")
def second_tension(k, C, h, n, fast, one):
    """Term n of the drive strand's tension."""
    stretch = C[X, n] - C[S, n]
    rate = (n + 1) * C[X, n + 1] / h - C[W, n]
    rest = one * k[REST] if n == 0 else 0.0
    tension = k[C2] * stretch + k[B2] * rate + rest
    if fast != 0.0:
        C[G2, n] = k[RATIO2] * (k[DAMPING_SLOPE] * rate + k[STIFFNESS_SLOPE] * (stretch + rest / k[C2]))
        tension += beyond_threshold(C, G2, n)
    return tension


@compiled("UniTuple(f8, 2)(f8[::1], f8[:, ::1], f8, f8, f8, i8, f8, f8, f8)")
def series(k, C, h, taut1, taut2, law, sign, fast, one):
    """Fills C with the series over h from C[U..W, 0] and the drive's C[X, 0..3]; returns terms and last size.

    one: 1, or 0 to leave out weight and rest tension (for the columns of a propagator).
    """
    single = k[RIM] == 0.0
    per_mass = h / k[MASS]
    per_rim = 0.0 if single else h / k[RIM]
    begin_friction(k, C, law, sign)
    before = size = math.inf
    n = 0
    while n < ORDER:
        if fast != 0.0:
            C[E, n] = fast * C[V, n] - (k[THRESHOLD] if n == 0 else 0.0)
        p = first_tension(k, C, h, n, fast, one, single)
        C[P, n] = p
        pull = p if taut1 != 0.0 else 0.0
        weight = one * k[WEIGHT] if n == 0 else 0.0
        C[V, n + 1] = per_mass * (pull - weight - k[DRY] * C[Y, n]) / (n + 1)
        C[U, n + 1] = h * C[V, n] / (n + 1)
        if not single:
            q = second_tension(k, C, h, n, fast, one)
            C[Q, n] = q
            C[W, n + 1] = per_rim * ((q if taut2 != 0.0 else 0.0) - pull) / (n + 1)
            C[S, n + 1] = h * C[W, n] / (n + 1)
        next_friction(k, C, law, n)
        before = size
        size = abs(C[V, n + 1]) + abs(C[W, n + 1]) + per_mass * k[DRY] * abs(C[Y, n + 1])
        n += 1
        if n > 3 and size < k[TOLERANCE] and before < k[TOLERANCE]:
            break
    return float(n), max(size, before)
