"""A latent term in time: trains of hat functions as forces or errors, and tables over what a term depends on.

Hat h of a train of TRAIN stands at every time that is h spacings beyond a multiple of TRAIN spacings, so that a window
shorter than the train meets each hat once; all windows are simulated with one hat at once.
"""

from __future__ import annotations

import math

from numba import cfunc, njit, types

from twin.kernels import composed_slots as k
from twin.kernels.composed_call import DYNAMICS, INPUT, SENSOR

TRAIN = 24
_P = types.CPointer(types.float64)


@njit("float64(float64,float64,float64)", cache=True)
def hat(time, index, spacing):  # type: ignore[no-untyped-def]
    """Height at `time` of hat `index`."""
    phase = (time / spacing - index) % TRAIN
    return max(0.0, 1.0 - min(phase, TRAIN - phase))


@cfunc(DYNAMICS, cache=True)
def guide_hat(q, p):  # type: ignore[no-untyped-def]
    """p: -, size, hat, spacing. A force on the weight along +u."""
    q[k.G] -= p[1] * hat(q[k.TIME], p[2], p[3])


@cfunc(DYNAMICS, cache=True)
def rim_hat(q, p):  # type: ignore[no-untyped-def]
    """A force on the rim along +s."""
    q[k.R] -= p[1] * hat(q[k.TIME], p[2], p[3])


@cfunc(DYNAMICS, cache=True)
def fibre_hat(q, p):  # type: ignore[no-untyped-def]
    """A tension in both strands."""
    size = p[1] * hat(q[k.TIME], p[2], p[3])
    q[k.E1] += size
    q[k.E2] += size


@cfunc(SENSOR, cache=True)
def dial_hat(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    """An error of the dial gauge, m."""
    for i in range(int(about[0])):
        position[i] += p[1] * hat(about[2] + i * about[1], p[2], p[3])


@cfunc(SENSOR, cache=True)
def gauge_hat(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    """An error of the force gauge, N."""
    for i in range(int(about[0])):
        force[i] += p[1] * hat(about[2] + i * about[1], p[2], p[3])


@cfunc(INPUT, cache=True)
def drive_hat(x, speed, about, p):  # type: ignore[no-untyped-def]
    """An error of the drive's position, m."""
    for i in range(int(about[0])):
        time = i * about[1]
        x[i] += p[1] * hat(time, p[2], p[3])
        later, sooner = hat(time + 0.5 * about[1], p[2], p[3]), hat(time - 0.5 * about[1], p[2], p[3])
        speed[i] += p[1] * (later - sooner) / about[1]


@njit(types.float64(types.float64, _P), cache=True)
def table(value, p):  # type: ignore[no-untyped-def]
    """Piecewise linear over knots p[2] + i p[3], i < p[4], heights from p[5] on; constant beyond the ends."""
    last = int(p[4]) - 1
    place = min(max((value - p[2]) / p[3], 0.0), float(last))
    i = min(int(place), last - 1)
    return p[5 + i] + (place - i) * (p[6 + i] - p[5 + i])


@cfunc(DYNAMICS, cache=True)
def guide_table(q, p):  # type: ignore[no-untyped-def]
    """p[1]: 100 + slot for a force along +u; 200 + slot for friction against the motion."""
    kind = int(p[1])
    slot = kind % 100
    value = q[slot] / q[k.RADIUS] if slot == k.S else (q[k.T1] if slot == k.T2 else q[slot])
    if kind >= 200:
        q[k.G] += table(value, p) * q[k.SMOOTH]
    else:
        q[k.G] -= table(value, p)


@cfunc(DYNAMICS, cache=True)
def rim_table(q, p):  # type: ignore[no-untyped-def]
    """As `guide_table`, on the rim."""
    kind = int(p[1])
    slot = kind % 100
    value = q[slot] / q[k.RADIUS] if slot == k.S else q[slot]
    sign = math.tanh(q[k.W] / 0.002) if kind >= 200 else -1.0
    q[k.R] += table(value, p) * sign


@cfunc(SENSOR, cache=True)
def dial_table(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    """An error of the dial gauge over the true position, p[1] = 101, or over time or speed."""
    slot = int(p[1]) % 100
    for i in range(int(about[0])):
        value = simulated[5 * i + slot - 1] if slot > 0 else about[2] + i * about[1]
        position[i] += table(value, p)


@cfunc(SENSOR, cache=True)
def gauge_table(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    """An error of the force gauge over u, u' (slots 1, 2), the true force (18) or time (0)."""
    slot = int(p[1]) % 100
    for i in range(int(about[0])):
        value = about[2] + i * about[1]
        if slot == k.U or slot == k.V:
            value = simulated[5 * i + slot - 1]
        elif slot == k.T2:
            value = simulated[5 * i + 2]
        force[i] += table(value, p)


@cfunc(INPUT, cache=True)
def drive_table(x, speed, about, p):  # type: ignore[no-untyped-def]
    """An error of the drive's position over its place."""
    for i in range(int(about[0])):
        value = x[i]
        slope = (table(value + 1e-6, p) - table(value - 1e-6, p)) / 2e-6
        x[i] += table(value, p)
        speed[i] *= 1.0 + slope
