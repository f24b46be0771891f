"""The simulated stand's inner loops, compiled: done thousands of times a second, a few samples at a time."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def sample_path(pieces, end, times, origin):  # type: ignore[no-untyped-def]
    """(x - origin, x', x'') [n, 3] at rising times [n] on pieces (time, x, x', x''); at rest from `end` on."""
    out = np.zeros((times.size, 3))
    last = pieces.shape[0] - 1
    if times[0] >= end:
        out[:, 0] = pieces[last, 1] - origin
        return out
    k = 0
    for i in range(times.size):
        while k < last and pieces[k + 1, 0] <= times[i]:
            k += 1
        t, x, v, a = times[i] - pieces[k, 0], pieces[k, 1], pieces[k, 2], pieces[k, 3]
        out[i, 0] = x + t * (v + 0.5 * a * t) - origin
        out[i, 1] = v + a * t
        out[i, 2] = a
    return out


@njit(cache=True)
def keep(kept, end, x, u, true_u, force, true_force):  # type: ignore[no-untyped-def]
    """Five channels [n] into kept [5, m] from column `end` on."""
    for i in range(x.size):
        kept[0, end + i] = x[i]
        kept[1, end + i] = u[i]
        kept[2, end + i] = true_u[i]
        kept[3, end + i] = force[i]
        kept[4, end + i] = true_force[i]


@njit(cache=True)
def look_up(kept, row, times, start, grid, shift, last, out):  # type: ignore[no-untyped-def]
    """Two rows of kept at times [n], straight between grid points: column (time - start)/grid - shift."""
    for i in range(times.size):
        place = (times[i] - start) / grid - shift
        below = min(int(place), last)
        share = place - below
        for k in range(2):
            out[k, i] = kept[row + k, below] * (1.0 - share) + kept[row + k, below + 1] * share


@njit(cache=True)
def take_ring(  # type: ignore[no-untyped-def]
    counter, time, x, times, position, rate, epoch, drift, noise, sigma, resolution, unit, cells, newest
):
    """The ring's samples from `counter` on, one for each noise [n]: their differences into cells; returned are their
    due times, values, true values and the newest as a number.

    time, x: the point before the first of times [m] and positions [m].
    """
    n = noise.size
    due, value, true = np.empty(n), np.empty(n), np.empty(n)
    k = 0
    t1, x1 = times[0], position[0]
    for i in range(n):
        t = epoch + (counter + i) / rate / (1.0 + drift)
        while k < times.size - 1 and t1 < t:
            time, x = t1, x1
            k += 1
            t1, x1 = times[k], position[k]
        share = min(max((t - time) / (t1 - time), 0.0), 1.0) if t1 > time else 1.0
        here = x + share * (x1 - x)
        read = here + sigma * noise[i]
        if resolution > 0.0:
            read = np.rint(read / resolution) * resolution
        counts = np.int64(np.rint(read / unit))
        cells[(counter + i) % cells.size] = min(max(counts - newest, -32768), 32767)
        newest = counts
        due[i], value[i], true[i] = t, counts * unit, here
    return due, value, true, newest


@njit(cache=True)
def sample_times(first, rate, epoch, drift, tick, time):  # type: ignore[no-untyped-def]
    """Device and true times of samples [n] from number `first` on."""
    for i in range(tick.size):
        tick[i] = (first + i) / rate
        time[i] = epoch + tick[i] / (1.0 + drift)


@njit(cache=True)
def digitise(sensed, times, sigma, zero, step, spike, spike_value, limit, until, values, faulty):  # type: ignore[no-untyped-def]
    """What a gauge makes of a signal [n]: values, which hold its noise and take the outcome, and whether any is faulty.

    Before the time `spike` it reads `spike_value` more; faulty is what is beyond the limit or before the time `until`.
    """
    some = False
    for i in range(sensed.size):
        value = sensed[i] + (zero + sigma * values[i])
        if times[i] < spike:
            value += spike_value
        value = np.rint(value / step) * step if step > 0.0 else value
        values[i] = value
        faulty[i] = abs(value) > limit or times[i] < until
        some |= faulty[i]
    return some
