"""What every discretised fibre's constants begin with: the rig, laid out in the plane of the fibre.

The pulley's centre is the origin and the arc is symmetric about +y; the fibre runs clockwise over it from the weight
to the drive. With a lateral offset the weight's strand swivels with its plane; its
length is that of `twin.rigs.strand`.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stand.setup import Setup, System
from twin.rigs import axial_stiffness, relaxation_time, rest_tension, strand

MASS, WEIGHT, NORMAL, DRY, DRY_SPEED, TABLE, TABLE_POINTS = range(7)
RADIUS, RIM, ALONG, OFFSET, DRIVE_STRAND, SLIDING = range(7, 13)
WX, WY, WTX, WTY, DX, DY, DTX, DTY, GX, GY = range(13, 23)
EA, TAU, LENGTH, FIBRE_MASS, REST, DRAG = range(23, 29)
RIG = 32  # constants before a model's own

Float = NDArray[np.float64]


def pack_rig(setup: Setup, own: int, *, sliding: float = 0.0, drag: float = 0.0) -> Float:
    """The rig's constants, float64 [RIG + own + table], the model's own zero and the friction table behind them.

    sliding: friction coefficient between fibre and pulley. drag: mass-proportional damping of the fibre, 1/s.
    """
    curve = setup.guide_friction_curve
    table = np.zeros(0) if curve is None else np.ascontiguousarray(curve, dtype=np.float64).reshape(-1)
    c = np.zeros(RIG + own + len(table))
    c[RIG + own :] = table
    c[TABLE], c[TABLE_POINTS] = RIG + own, len(table) // 2
    c[MASS], c[WEIGHT], c[REST] = setup.mass, setup.rest_tension, rest_tension(setup)
    c[NORMAL] = setup.mass * setup.gravity * math.cos(setup.incline_angle)
    c[DRY], c[DRY_SPEED] = setup.guide_friction, setup.guide_friction_velocity
    path = strand(setup)
    c[ALONG], c[OFFSET], c[SLIDING], c[DRAG] = path.along, path.offset, sliding, drag
    c[EA], c[TAU], c[FIBRE_MASS] = axial_stiffness(setup), relaxation_time(setup), setup.fibre_mass
    pulley = setup.system is System.WFPD
    arc = setup.pulley_radius * setup.wrap_angle if pulley else 0.0
    c[RADIUS] = setup.pulley_radius if pulley else 0.0
    c[RIM] = setup.pulley_inertia / setup.pulley_radius**2 if pulley else 1.0
    c[DRIVE_STRAND] = setup.drive_strand_length if pulley else 0.0
    c[LENGTH] = (setup.weight_strand_length + arc + c[DRIVE_STRAND]) / (1.0 + c[REST] / c[EA])
    _pack_plane(c, setup, setup.wrap_angle if pulley else 0.0)
    return c


def _pack_plane(c: Float, setup: Setup, wrap: float) -> None:
    radius, up = c[RADIUS], math.pi / 2 - setup.incline_angle
    for x, y, tx, ty, angle in ((WX, WY, WTX, WTY, math.pi / 2 + wrap / 2), (DX, DY, DTX, DTY, math.pi / 2 - wrap / 2)):
        c[x], c[y] = radius * math.cos(angle), radius * math.sin(angle)
        c[tx], c[ty] = math.sin(angle), -math.cos(angle)
    c[GX] = -setup.gravity * (math.cos(up) * c[WTX] - math.sin(up) * c[WTY])
    c[GY] = -setup.gravity * (math.sin(up) * c[WTX] + math.cos(up) * c[WTY])
