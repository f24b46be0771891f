"""A delay that may grow along a window, and a first-order lag, for the causes that need one."""

import math

import numpy as np
from numba import njit, types

_VECTOR = types.CPointer(types.float64)


@njit(types.void(_VECTOR, types.int64, types.float64, types.float64), cache=True)
def delay_line(y, n, samples, growth):  # type: ignore[no-untyped-def]
    """y[i] becomes y at i - samples - growth i, cubic between samples, straight on beyond the ends; in place."""
    if samples == 0.0 and growth == 0.0:
        return
    old = np.empty(n)
    for i in range(n):
        old[i] = y[i]
    for i in range(n):
        place = i - samples - growth * i
        a = int(np.floor(place))
        if a < 0:
            y[i] = old[0] + (old[1] - old[0]) * place
        elif a >= n - 1:
            y[i] = old[n - 1] + (old[n - 1] - old[n - 2]) * (place - (n - 1))
        else:
            t = place - a
            rise = old[a + 1] - old[a]
            p = 0.5 * (old[a + 1] - old[a - 1]) if a > 0 else rise
            q = 0.5 * (old[a + 2] - old[a]) if a < n - 2 else rise
            y[i] = old[a] + t * (p + t * (3.0 * rise - 2.0 * p - q + t * (p + q - 2.0 * rise)))


@njit(types.void(_VECTOR, types.int64, types.float64), cache=True)
def lag_line(y, n, tau):  # type: ignore[no-untyped-def]
    """y behind a first-order lag of tau samples, exact for a signal straight between them and before; in place."""
    if tau < 1e-6:
        return
    decay = math.exp(-1.0 / tau)
    gone = tau * (1.0 - decay)
    old = y[0]
    held = old - tau * 0.25 * (y[4] - y[0])
    y[0] = held
    for i in range(1, n):
        new = y[i]
        held = held * decay + old * (gone - decay) + new * (1.0 - gone)
        old = new
        y[i] = held
