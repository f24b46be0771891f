"""The friction laws, compiled: force(v, z, applied, p) and rate(v, z, p); see `twin.friction`."""

from __future__ import annotations

import math

from twin.friction import FORCE, RATE
from twin.kernels.jit import compiler

compiled = compiler("friction")


@compiled(RATE)
def no_state(v, z, p):  # type: ignore[no-untyped-def]
    """A law without an inner state."""
    return 0.0


@compiled(FORCE)
def smoothed_coulomb(v, z, applied, p):  # type: ignore[no-untyped-def]
    """F_c tanh(v / v_s)."""
    return p[0] * math.tanh(v / p[1])


@compiled(FORCE)
def coulomb_with_stick(v, z, applied, p):  # type: ignore[no-untyped-def]
    """F_c sgn(v) outside the zero-speed band, what was applied (up to F_s) inside."""
    if abs(v) > p[2]:
        return math.copysign(p[0], v)
    return min(max(applied, -p[1]), p[1])


@compiled(FORCE)
def stribeck(v, z, applied, p):  # type: ignore[no-untyped-def]
    """(F_c + (F_s - F_c) exp(-(v/v_st)^2)) tanh(v/v_s) + sigma_2 v."""
    return (p[0] + (p[1] - p[0]) * math.exp(-((v / p[2]) ** 2))) * math.tanh(v / p[3]) + p[4] * v


@compiled(RATE)
def lugre_rate(v, z, p):  # type: ignore[no-untyped-def]
    """dz/dt = v - sigma_0 |v| z / g(v)."""
    return v - p[0] * abs(v) * z / (p[3] + (p[4] - p[3]) * math.exp(-((v / p[5]) ** 2)))


@compiled(FORCE)
def lugre(v, z, applied, p):  # type: ignore[no-untyped-def]
    """sigma_0 z + sigma_1 dz/dt + sigma_2 v."""
    return p[0] * z + p[1] * lugre_rate(v, z, p) + p[2] * v


@compiled(RATE)
def dahl_rate(v, z, p):  # type: ignore[no-untyped-def]
    """dz/dt = v |1 - s|^n sgn(1 - s) with s = sigma z sgn(v) / F_c."""
    left = 1.0 - p[0] * z * math.copysign(1.0, v) / p[1]
    return v * math.copysign(abs(left) ** p[2], left)


@compiled(FORCE)
def dahl(v, z, applied, p):  # type: ignore[no-untyped-def]
    """Sigma z."""
    return p[0] * z


@compiled(FORCE)
def table(v, z, applied, p):  # type: ignore[no-untyped-def]
    """Linear between the points (v_0, F_0, v_1, F_1, ...), constant beyond them."""
    n = len(p) // 2
    if v <= p[0]:
        return p[1]
    for i in range(1, n):
        if v < p[2 * i]:
            part = (v - p[2 * i - 2]) / (p[2 * i] - p[2 * i - 2])
            return p[2 * i - 1] + part * (p[2 * i + 1] - p[2 * i - 1])
    return p[2 * n - 1]
