"""The rigs: each one is its data and its geometry; a model that asks only for these works on every rig."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from stand.errors import InputError
from stand.excitation.spec import Excitation, Shape
from stand.setup import Setup, System
from twin.parameter import Source


@dataclass(frozen=True)
class Rig:
    """One rig (a plug-in: one instance in one file).

    setup(): its nominal data. excitations: the shapes it can be driven with.
    """

    name: str
    title: str
    source: Source
    setup: Callable[[], Setup]
    excitations: frozenset[Shape]


@dataclass(frozen=True, slots=True)
class Strand:
    """The strand at the weight as geometry: its path runs parallel to the plane of symmetry, `offset` beside it.

    along: distance along the path from u = 0 to the point nearest to the pulley's tangent point, m. offset: m.
    """

    along: float
    offset: float

    def length(self, u: float) -> float:
        """Distance from the pulley's tangent point to the weight at `u`, m: sqrt((along - u)^2 + offset^2)."""
        return math.hypot(self.along - u, self.offset)

    def cosine(self, u: float) -> float:
        """-d length/du: the share of the strand's tension that pulls along the guide."""
        return (self.along - u) / self.length(u)

    def sine(self, u: float) -> float:
        """The share of the strand's tension that presses sideways on the guide."""
        return self.offset / self.length(u)


def strand(setup: Setup) -> Strand:
    """The geometry of the weight's strand; without a lateral offset it lies along the guide."""
    offset = setup.lateral_offset or 0.0
    if offset >= setup.weight_strand_length:
        remedy = "The strand at rest must be longer than the offset"
        raise InputError("no strand can be that short", where="setup/lateral_offset", value=offset, remedy=remedy)
    return Strand(math.sqrt(setup.weight_strand_length**2 - offset**2), offset)


def rest_tension(setup: Setup) -> float:
    """Tension that holds the weight without friction, N: m g sin(alpha) / cosine of the strand."""
    return setup.rest_tension / strand(setup).cosine(0.0)


def friction_factor(setup: Setup, tension: float, u: float) -> float:
    """How much the guide's friction grows by the fibre's sideways pull, >= 1.

    sqrt(N^2 + S^2) / N with N = m g cos(alpha) and S = tension * sine: the guide carries both (Coulomb).
    At alpha = 90 deg, N = 0, the friction is the guide's own and isn't scaled.
    """
    normal = setup.mass * setup.gravity * math.cos(setup.incline_angle)
    side = tension * strand(setup).sine(u)
    return math.hypot(normal, side) / normal if normal > 1e-6 * setup.mass * setup.gravity else 1.0


def axial_stiffness(setup: Setup) -> float:
    """EA = c L_free, N."""
    return setup.fibre_stiffness * setup.free_length


def relaxation_time(setup: Setup) -> float:
    """b / c, s: the fibre's damping is proportional to its stiffness."""
    return setup.fibre_damping / setup.fibre_stiffness


def release(setup: Setup, drop_height: float) -> Excitation:
    """Weight lifted by `drop_height` (m) from hanging at rest and let go; InputError outside 0 to 0.2 m."""
    if setup.system is not System.WF:
        raise InputError("only the weight-fibre rig is released", where="excitation/shape", value=str(setup.system))
    if not 0.0 < drop_height <= 0.2:
        raise InputError("out of range", where="excitation/drop_height", value=drop_height, remedy="0 to 0.2 m")
    return Excitation(shape=Shape.RELEASE, drop_height=drop_height)


DRIVEN = frozenset({Shape.RECTANGULAR, Shape.TRAPEZOIDAL, Shape.QUASI_SINUSOIDAL})
RELEASED = frozenset({Shape.RELEASE})
