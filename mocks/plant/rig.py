"""The rigs of the simulated world and what they are made of, in SI (angles in rad)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

WFPD, WF, LINEAR_DRIVE = "weight-fibre-pulley-drive", "weight-fibre", "linear-drive"


@dataclass(frozen=True)
class Rig:
    """True values of one simulated stand; the defaults are the published WFPD stand.

    stiffness N/m and damping N*s/m are the whole fibre's; strands scale with L_free/L_i.
    """

    system: str = WFPD
    weight_mass: float = 3.096
    added_mass: float = 0.0
    incline_angle: float = math.radians(30.0)
    gravity: float = 9.81
    fibre_length: float = 1.82
    fibre_mass: float = 4.95e-3
    weight_strand_length: float = 0.781
    drive_strand_length: float = 0.9343
    pulley_radius: float = 0.040
    pulley_inertia: float = 2.0e-4
    wrap_angle: float = math.radians(150.0)
    fibre_stiffness: float = 34e3
    fibre_damping: float = 27.5
    guide_friction: float = 3.0
    guide_friction_velocity: float = 0.002
    moving_mass: float = 12.0

    @property
    def mass(self) -> float:
        """Weight with what was added, kg."""
        return self.weight_mass + self.added_mass

    @property
    def free_length(self) -> float:
        """Both strands, m."""
        return self.weight_strand_length + self.drive_strand_length

    @property
    def rest_tension(self) -> float:
        """Tension that holds the weight on the incline, N."""
        return self.mass * self.gravity * math.sin(self.incline_angle)

    def but(self, **values: Any) -> Rig:
        """The same rig with some values changed."""
        return replace(self, **values)


def coulomb(incline_angle: float) -> float:
    """Guide friction that goes with the weight's pressure on the guide: 3.0 N at 30 deg, 2.45 N at 45 deg, 0 at 90."""
    return max(0.0, round(3.0 * math.cos(incline_angle) / math.cos(math.radians(30.0)), 9))


def weight_fibre(degrees: float = 30.0, **values: Any) -> Rig:
    """The rig without pulley and drive: 0.559 m of fibre with the constants that were tuned for it."""
    angle = math.radians(degrees)
    rig = Rig(
        system=WF,
        incline_angle=angle,
        fibre_length=0.559,
        fibre_mass=1.63e-3,
        weight_strand_length=0.559,
        drive_strand_length=0.0,
        pulley_inertia=0.0,
        fibre_stiffness=104e3,
        fibre_damping=83.47,
        guide_friction=coulomb(angle),
    )
    return rig.but(**values)


def linear_drive(mass: float = 12.0) -> Rig:
    """A mass on a guide under a known force; no friction unless something hidden brings it."""
    return Rig(system=LINEAR_DRIVE, moving_mass=mass, guide_friction=0.0)
