"""What the gauges make of simulated windows, and what the drive makes of its recorded position."""

from __future__ import annotations

import numpy as np
from numba import njit

from twin.kernels.composed_call import call_input, call_sensor

_V = "float64[::1]"
_M = "float64[:,::1]"
_A = "int64[::1]"


@njit(f"float64({_V},float64)", cache=True, nogil=True)
def at(y, place):  # type: ignore[no-untyped-def]
    """y at a place between samples, by cubic (Catmull-Rom) where there are neighbours, straight on at the ends."""
    n = len(y)
    i = int(np.floor(place))
    if i < 0:
        return y[0] + (y[1] - y[0]) * place
    if i >= n - 1:
        return y[n - 1] + (y[n - 1] - y[n - 2]) * (place - (n - 1))
    t = place - i
    a, b = y[i], y[i + 1]
    if i == 0 or i == n - 2:
        return a + (b - a) * t
    p, q = 0.5 * (b - y[i - 1]), 0.5 * (y[i + 2] - a)
    return a + t * (p + t * (3.0 * (b - a) - 2.0 * p - q + t * (p + q - 2.0 * (b - a))))


@njit(f"void({_V},float64,{_V})", cache=True, nogil=True)
def shift(y, samples, work):  # type: ignore[no-untyped-def]
    """y later by a number of samples (any real), in place."""
    if samples == 0.0:
        return
    n = len(y)
    for i in range(n):
        work[i] = at(y, i - samples)
    for i in range(n):
        y[i] = work[i]


@njit(f"void(float64[:,:,::1],{_A},{_A},float64,float64,float64,{_A},{_M},float64[:,:,::1])", cache=True, nogil=True)
def sense(simulated, run, first, dt, late_u, late_F, hooks, p, out):  # type: ignore[no-untyped-def]
    """Gauge readings [w, n, 2] of simulated windows [w, n, 5]; both channels late by `late_*` s beyond the causes."""
    windows, n = simulated.shape[0], simulated.shape[1]
    position, force, work, about = np.empty(n), np.empty(n), np.empty(n), np.empty(4)
    for j in range(windows):
        for i in range(n):
            position[i] = simulated[j, i, 0]
            force[i] = simulated[j, i, 2]
        about[0] = n
        about[1] = dt
        about[2] = first[j] * dt
        about[3] = run[j]
        for m in range(len(hooks)):
            call_sensor(hooks[m], position, force, simulated[j], about, p, m)
        shift(position, late_u / dt, work)
        shift(force, late_F / dt, work)
        for i in range(n):
            out[j, i, 0] = position[i]
            out[j, i, 1] = force[i]


@njit(f"void({_V},{_V},float64,{_A},{_M})", cache=True, nogil=True)
def drive_end(x, speed, dt, hooks, p):  # type: ignore[no-untyped-def]
    """The fibre's drive end from the drive's recorded position, in place."""
    about = np.empty(2)
    about[0] = len(x)
    about[1] = dt
    for m in range(len(hooks)):
        call_input(hooks[m], x, speed, about, p, m)
