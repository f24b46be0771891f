# mypy: allow-untyped-defs, allow-untyped-calls
"""Where a strand falls slack or catches, and where the weight passes the threshold speed, within a step."""

from __future__ import annotations

import math

from twin.kernels.force_layout import C1, C2, REST, SIGNED, THRESHOLD
from twin.kernels.force_series import P, Q, S, U, V, X
from twin.kernels.jit import part

STRAND1, STRAND2, SPEED = 1, 2, 3
PARTS = 6
NEVER = 2.0


@part
def value(C, row, terms, at):
    """The polynomial of a row at `at` (a share of the step)."""
    total = 0.0
    for j in range(terms - 1, -1, -1):
        total = total * at + C[row, j]
    return total


@part
def swing(C, row, terms, end):
    """A bound on how far a row's polynomial moves from its first term up to `end`."""
    total = 0.0
    for j in range(terms - 1, 0, -1):
        total = (total + abs(C[row, j])) * end
    return total


@part
def margin(k, C, what, terms, now, single, at):
    """Above 0 while nothing switches: tension of a taut strand, slack of a slack one, distance to the threshold."""
    if what == SPEED:
        v = value(C, V, terms, at)
        speed = v if k[SIGNED] != 0.0 else abs(v)
        return speed - k[THRESHOLD] if now != 0.0 else k[THRESHOLD] - speed
    tension = value(C, P if what == STRAND1 else Q, terms, at)
    if now != 0.0:
        return tension
    if what == STRAND1:
        far = X if single != 0.0 else S
        stretch = value(C, far, terms, at) - value(C, U, terms, at) + k[REST] / k[C1]
        return -min(stretch, tension / k[C1])
    stretch = value(C, X, terms, at) - value(C, S, terms, at) + k[REST] / k[C2]
    return -min(stretch, tension / k[C2])


@part
def quiet(k, C, what, terms, now, single, end):
    """True where bounds alone show that `what` does not switch up to `end`."""
    if what == SPEED:
        if k[THRESHOLD] == math.inf:
            return True
        return margin(k, C, what, terms, now, single, 0.0) > swing(C, V, terms, end)
    if now != 0.0:
        row = P if what == STRAND1 else Q
        return C[row, 0] > swing(C, row, terms, end)
    near = U if what == STRAND1 else S
    far = X if what == STRAND2 or single != 0.0 else S
    c = k[C1] if what == STRAND1 else k[C2]
    stretch = C[far, 0] - C[near, 0] + k[REST] / c
    return -stretch > swing(C, far, terms, end) + swing(C, near, terms, end)


@part
def root(k, C, what, terms, now, single, low, high):
    """The switch between `low` (margin above 0) and `high` (below 0), on its far side, by Illinois steps."""
    a, b = low, high
    fa, fb = max(margin(k, C, what, terms, now, single, a), 1e-300), margin(k, C, what, terms, now, single, b)
    side = 0
    for _ in range(60):
        if b - a <= 4e-16 * b:
            break
        at = b - fb * (b - a) / (fb - fa)
        if not a < at < b:
            at = 0.5 * (a + b)
        f = margin(k, C, what, terms, now, single, at)
        if f > 0.0:
            a, fa = at, f
            if side == 1:
                fb *= 0.5
            side = 1
        else:
            b, fb = at, f
            if side == -1:
                fa *= 0.5
            side = -1
            if f == 0.0:
                break
    return b


@part
def switch(k, C, what, terms, now, single, end):
    """The first switch of `what` in (0, end], as a share of the step, or NEVER."""
    if quiet(k, C, what, terms, now, single, end):
        return NEVER
    low = 0.0
    for piece in range(1, PARTS + 1):
        high = end * piece / PARTS
        if margin(k, C, what, terms, now, single, high) < 0.0:
            return root(k, C, what, terms, now, single, low, high)
        low = high
    return NEVER
