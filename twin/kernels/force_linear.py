# mypy: allow-untyped-defs, allow-untyped-calls
"""Exact propagation over one sample where nothing switches: between switches the force model is linear.

State at the end of a sample = M^T (u, u', s, s', drive's cubic, weight and rest tension, friction's
sign). The rows are unit responses, summed from the same series as everything else.
"""

from __future__ import annotations

import numpy as np

from twin.kernels.force_layout import TOLERANCE
from twin.kernels.force_series import CREEPING, ORDER, SLIDING, S, U, V, W, X, series
from twin.kernels.force_switch import value
from twin.kernels.jit import part

INPUTS = 10
#: propagators: strand 1 taut, strand 2 taut, sliding or creeping
SLOTS = 8


@part
def slot_of(taut1, taut2, law):
    """Which propagator serves these strands and this law of friction."""
    return (1 if taut1 != 0.0 else 0) + (2 if taut2 != 0.0 else 0) + (4 if law == CREEPING else 0)


@part
def place_drive(C, cubic, at, share):
    """Writes the drive's cubic (powers of the sample's share) as powers of a step that begins at `at`."""
    C[X, 0] = cubic[0] + at * (cubic[1] + at * (cubic[2] + at * cubic[3]))
    C[X, 1] = share * (cubic[1] + at * (2.0 * cubic[2] + 3.0 * at * cubic[3]))
    C[X, 2] = share * share * (cubic[2] + 3.0 * at * cubic[3])
    C[X, 3] = share * share * share * cubic[3]


@part
def respond(k, C, y, cubic, taut1, taut2, law, sign, one, dt):
    """Carries y linearly over a sample, in as many steps as the series asks for."""
    at, steps = 0.0, 0
    while at < 1.0:
        share = 1.0 - at
        for j in range(4):
            C[U + j, 0] = y[j]
        place_drive(C, cubic, at, share)
        terms, size = series(k, C, share * dt, taut1, taut2, law, sign, 0.0, one)
        eta = 1.0
        if size > k[TOLERANCE]:
            eta = 0.9 * (k[TOLERANCE] / size) ** (1.0 / ORDER)
        for j in range(4):
            y[j] = value(C, U + j, int(terms) + 1, eta)
        at = 1.0 if eta == 1.0 else at + eta * share
        steps += 1
    return steps


@part
def propagator(k, C, dt, taut1, taut2, law, M):
    """Fills M [10, 4]: to each unit input the response at the end of a sample."""
    y, cubic = np.zeros(4), np.zeros(4)
    for column in range(INPUTS):
        y[:] = 0.0
        cubic[:] = 0.0
        if column < 4:
            y[column] = 1.0
        elif column < 8:
            cubic[column - 4] = 1.0
        one = 1.0 if column == 8 else 0.0
        sign = 1.0 if column == 9 else 0.0
        # no friction but in its own column: SLIDING with sign 0 leaves it out, CREEPING is linear in v
        respond(k, C, y, cubic, taut1, taut2, law, sign, one, dt)
        M[column] = y
    C[X, :] = 0.0


assert (U, V, S, W) == (0, 1, 2, 3)
assert SLIDING != CREEPING
