"""Every number that the equations of motion need, as one record that the compiled kernel reads by name."""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass, fields

import numpy as np
from numpy.typing import NDArray

from mocks.plant.rig import WF, Rig

Float = NDArray[np.float64]


@dataclass
class Physics:
    """One stand's constants in SI; a rig gives the first part, hidden effects change any of them.

    Whole-fibre constants (c, b, ...) with share1 = L_free/L1, share2 = L_free/L2 that scale them to strands.
    """

    mass: float
    gravity_along: float  # g sin(alpha)
    rest_tension: float
    c: float
    b: float
    share1: float
    share2: float
    rim_mass: float  # J/r^2
    radius: float
    wrap: float
    friction: float  # guide's dry friction, N
    friction_velocity: float  # below it the guide creeps instead of sticking
    presliding: float = 2e-8  # m of the guide's bristles: too little to see beside the creep
    bearing_presliding: float = 2e-6  # m at the rim
    locked: float = 0.0  # 1: the fibre's upper end is fixed (no pulley, no drive)
    # fibre
    b_slope: float = 0.0
    b_threshold: float = 0.0
    c_slope: float = 0.0
    c_threshold: float = 0.0
    hardening: float = 0.0
    maxwell: float = 0.0
    maxwell_time: float = 1.0
    hysteresis: float = 0.0
    yield_elongation: float = 1.0
    creep: float = 0.0
    creep_time: float = 1.0
    mass1: float = 0.0  # the fibre's own mass: weight strand, arc, drive strand
    mass_arc: float = 0.0
    mass2: float = 0.0
    # pulley
    bearing: float = 0.0
    bearing_creep: float = 0.0
    rim_drag: float = 0.0
    eccentricity: float = 0.0
    eccentric_phase: float = 0.0
    slip: float = 0.0  # 0: the fibre never slides
    # guide and weight
    stribeck: float = 0.0
    stribeck_velocity: float = 1.0
    asymmetry: float = 0.0
    viscous: float = 0.0
    quadratic: float = 0.0
    stop_high: float = 0.250
    stop_low: float = -0.050
    stop_stiffness: float = 1e5
    stop_damping: float = 300.0
    spring: float = 0.0
    # drive
    compliance: float = 0.0
    # outside any catalogue
    fade: float = 0.0  # N of friction at the start that fades
    fade_time: float = 1.0
    pulse: float = 0.0
    pulse_frequency: float = 1.0
    pulse_phase: float = 0.0
    shake: float = 0.0  # acceleration of the base along the incline
    shake_frequency: float = 1.0
    shake_phase: float = 0.0
    load_friction: float = 0.0  # N per N of weight-strand tension above rest, squared
    tables: float = 0.0  # 1: the tables hold something
    rest_stretch: float = 0.0  # of the whole fibre under the weight's rest tension, creep included; set by `record`
    rest_stretch2: float = 0.0  # likewise under the tension that balances it on the drive's side of the pulley
    rest_pull: float = 0.0  # that tension
    step: float = 50e-6

    def record(self) -> NDArray[np.void]:
        """A record array of length 1 with these fields."""
        self.rest_pull = self.rest_tension * (1.0 + self.eccentricity / self.radius * math.cos(self.eccentric_phase))
        self.rest_stretch = self.stretch(self.rest_tension) + self.creep * self.rest_tension
        self.rest_stretch2 = self.stretch(self.rest_pull) + self.creep * self.rest_pull
        dtype = np.dtype([(f.name, np.float64) for f in fields(self)])
        return np.array([astuple(self)], dtype=dtype)

    def stretch(self, tension: float) -> float:
        """The whole fibre's elastic elongation d under a tension: c d (1 + hardening d) = tension, m."""
        plain = tension / self.c
        if abs(self.hardening) * plain < 1e-9:
            return plain
        return (math.sqrt(1.0 + 4.0 * self.hardening * plain) - 1.0) / (2.0 * self.hardening)


def physics(rig: Rig) -> Physics:
    """The constants of a rig without anything hidden."""
    length1, length2, free = rig.weight_strand_length, rig.drive_strand_length, rig.free_length
    return Physics(
        mass=rig.mass,
        gravity_along=rig.gravity * math.sin(rig.incline_angle),
        rest_tension=rig.rest_tension,
        c=rig.fibre_stiffness,
        b=rig.fibre_damping,
        share1=free / length1,
        share2=free / length2 if length2 else 1.0,
        rim_mass=rig.pulley_inertia / rig.pulley_radius**2,
        radius=rig.pulley_radius,
        wrap=rig.wrap_angle,
        friction=rig.guide_friction,
        friction_velocity=rig.guide_friction_velocity,
        locked=1.0 if rig.system == WF else 0.0,
    )


@dataclass
class Tables:
    """Forces that hang on a place or a speed, sampled on uniform axes; the kernel interpolates linearly.

    guide: N on the weight over u. patch: N added to the guide's dry friction over u. rim: N at the rim over s.
    speed: N on the weight over u'. All oppose positive motion.
    """

    guide: Float
    patch: Float
    rim: Float
    speed: Float

    PLACES = np.linspace(-0.08, 0.28, 7201)
    SPEEDS = np.linspace(-3.0, 3.0, 7201)

    def packed(self) -> Float:
        """Float64 [4, 7201]."""
        return np.ascontiguousarray(np.stack([self.guide, self.patch, self.rim, self.speed]))


def no_tables() -> Tables:
    """Tables that hold nothing."""
    zeros = np.zeros(Tables.PLACES.size)
    return Tables(zeros.copy(), zeros.copy(), zeros.copy(), zeros.copy())
