"""The rig as the discretised fibres feel it: the fibre's two ends, the guide, the pulley's rim."""

from __future__ import annotations

import math

from twin.kernels.fibre_layout import (
    ALONG,
    DRIVE_STRAND,
    DRY,
    DRY_SPEED,
    DTX,
    DTY,
    DX,
    DY,
    NORMAL,
    OFFSET,
    TABLE,
    TABLE_POINTS,
    WTX,
    WTY,
    WX,
    WY,
)
from twin.kernels.jit import part


@part
def weight_end(c, u):  # type: ignore[no-untyped-def]
    """Where the fibre holds the weight: x, y, dx/du, dy/du, d2x/du2, d2y/du2."""
    if c[OFFSET] == 0.0:
        length = c[ALONG] - u
        return c[WX] - c[WTX] * length, c[WY] - c[WTY] * length, c[WTX], c[WTY], 0.0, 0.0
    length = math.hypot(c[ALONG] - u, c[OFFSET])
    cosine, bend = (c[ALONG] - u) / length, (c[OFFSET] / length) ** 2 / length
    x, y = c[WX] - c[WTX] * length, c[WY] - c[WTY] * length
    return x, y, c[WTX] * cosine, c[WTY] * cosine, -c[WTX] * bend, -c[WTY] * bend


@part
def drive_end(c, x, w):  # type: ignore[no-untyped-def]
    """Where the drive holds the fibre: x, y and their rates."""
    length = c[DRIVE_STRAND] + x
    return c[DX] + c[DTX] * length, c[DY] + c[DTY] * length, c[DTX] * w, c[DTY] * w


@part
def table(c, at, n, v):  # type: ignore[no-untyped-def]
    """The friction table at v: force and slope, constant beyond its points."""
    if v <= c[at]:
        return c[at + 1], 0.0
    for i in range(1, n):
        here = at + 2 * i
        if v < c[here]:
            slope = (c[here + 1] - c[here - 1]) / (c[here] - c[here - 2])
            return c[here - 1] + slope * (v - c[here - 2]), slope
    return c[at + 2 * n - 1], 0.0


@part
def guide(c, u, v, tension):  # type: ignore[no-untyped-def]
    """Friction of the guide and its slope over v; a sideways pull of the fibre adds to the normal load."""
    n = int(c[TABLE_POINTS])
    if n == 0:
        shape = math.tanh(v / c[DRY_SPEED])
        force, slope = c[DRY] * shape, c[DRY] / c[DRY_SPEED] * (1.0 - shape * shape)
    else:
        force, slope = table(c, int(c[TABLE]), n, v)
    if c[OFFSET] > 0.0 and c[NORMAL] > 0.0:
        side = tension * c[OFFSET] / math.hypot(c[ALONG] - u, c[OFFSET])
        factor = math.hypot(1.0, side / c[NORMAL])
        return force * factor, slope * factor
    return force, slope
