"""Coefficients of the stepper's Runge-Kutta methods: the stages' rows, their times behind them."""

from __future__ import annotations

import math

import numpy as np

from twin.kernels.jit import part

_G = 1.0 - 1.0 / math.sqrt(2.0)

#: Alexander 1977, Theorem 5; the last column: the stages' times
_TWO = np.array([[_G, 0.0, _G], [1.0 - _G, _G, 1.0]])

#: Kennedy, Carpenter 2003, ARK4(3)6L[2]SA-ESDIRK
_FOUR = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 4, 1 / 4, 0.0, 0.0, 0.0, 0.0, 1 / 2],
        [8611 / 62500, -1743 / 31250, 1 / 4, 0.0, 0.0, 0.0, 83 / 250],
        [5012029 / 34652500, -654441 / 2922500, 174375 / 388108, 1 / 4, 0.0, 0.0, 31 / 50],
        [
            15267082809 / 155376265600,
            -71443401 / 120774400,
            730878875 / 902184768,
            2285395 / 8070912,
            1 / 4,
            0.0,
            17 / 20,
        ],
        [82889 / 524892, 0.0, 15625 / 83664, 69875 / 102672, -2260 / 8211, 1 / 4, 1.0],
    ]
)


@part
def tableau(order):  # type: ignore[no-untyped-def]
    """[s, s + 1]: the method of that order, 2 or 4."""
    return _FOUR if order == 4 else _TWO
