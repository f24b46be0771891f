"""The rig as its operator believes it to be: the baseline of every comparison."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from enum import StrEnum
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError


class System(StrEnum):
    """The rigs that a recording may come from."""

    WFPD = "weight-fibre-pulley-drive"
    WF = "weight-fibre"
    LINEAR_DRIVE = "linear-drive"


def _quantity(value: float | None, unit: str, meaning: str) -> float:
    """A field with its unit at the edges (files, screens); inside it is SI."""
    return field(default=value, metadata={"unit": unit, "meaning": meaning})  # type: ignore[return-value]


@dataclass(frozen=True)
class Setup:
    """Every scalar of `/entry/setup`, in SI (angles in rad); defaults are the nominal WFPD stand (S0, S1).

    uncertainty: one sigma in SI for each name that the operator stated one for.
    """

    system: System = System.WFPD
    weight_mass: float = _quantity(3.096, "kg", "weight without the added mass")
    added_mass: float = _quantity(0.0, "kg", "mass added to the weight")
    incline_angle: float = _quantity(math.radians(30.0), "deg", "incline against the horizontal")
    gravity: float = _quantity(9.81, "m/s^2", "gravity")
    fibre_length: float = _quantity(1.82, "m", "whole fibre, arc on the pulley included")
    fibre_mass: float = _quantity(4.95e-3, "kg", "whole fibre")
    weight_strand_length: float = _quantity(0.781, "m", "free strand from weight to pulley")
    drive_strand_length: float = _quantity(0.9343, "m", "free strand from pulley to drive")
    pulley_radius: float = _quantity(0.040, "m", "pulley rim")
    pulley_inertia: float = _quantity(2.0e-4, "kg*m^2", "pulley about its axis")
    wrap_angle: float = _quantity(math.radians(150.0), "deg", "fibre's wrap on the pulley")
    fibre_stiffness: float = _quantity(34e3, "N/m", "whole fibre")
    fibre_damping: float = _quantity(27.5, "N*s/m", "whole fibre")
    guide_friction: float = _quantity(3.0, "N", "guide's dry friction")
    guide_friction_velocity: float = _quantity(0.002, "m/s", "smoothing speed of the guide's dry friction")
    lateral_offset: float | None = _quantity(None, "m", "weight's path off the drive-pulley plane")
    moving_mass: float | None = _quantity(None, "kg", "linear-drive: the mass that moves")
    guide_friction_curve: NDArray[np.float64] | None = None
    uncertainty: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))

    @property
    def mass(self) -> float:
        """Weight and added mass, kg."""
        return self.weight_mass + self.added_mass

    @property
    def free_length(self) -> float:
        """L_free = L1 + L2, m: what the fibre's stiffness refers to."""
        return self.weight_strand_length + self.drive_strand_length

    @property
    def rest_tension(self) -> float:
        """T0 = m g sin(alpha), N."""
        return self.mass * self.gravity * math.sin(self.incline_angle)

    def sigma(self, name: str) -> float:
        """One sigma of `name` in SI: as stated, or the default (5 %, angles 0.2 deg), never zero."""
        stated = self.uncertainty.get(name)
        return stated if stated is not None and stated > 0 else default_sigma(name, getattr(self, name))

    def with_values(self, **values: Any) -> Setup:
        """The same stand with some values changed."""
        return replace(self, **values)


def default_sigma(name: str, value: float) -> float:
    """The uncertainty used where none is stated: 5 % of the value, 0.2 deg for an angle."""
    return math.radians(0.2) if name.endswith("_angle") else 0.05 * abs(value) or 0.05


SCALARS: Mapping[str, str] = MappingProxyType(
    {f.name: f.metadata["unit"] for f in fields(Setup) if "unit" in f.metadata}
)
MEANINGS: Mapping[str, str] = MappingProxyType(
    {f.name: f.metadata["meaning"] for f in fields(Setup) if "unit" in f.metadata}
)

_POSITIVE = frozenset(
    {
        "weight_mass",
        "gravity",
        "weight_strand_length",
        "pulley_radius",
        "fibre_stiffness",
        "guide_friction_velocity",
    }
)


def nominal(system: System = System.WFPD) -> Setup:
    """The published stand: WFPD symmetric, or WF with the fibre of 0.559 m and S0's tuned constants."""
    if system is System.WF:
        return Setup(
            system=system,
            fibre_length=0.559,
            fibre_mass=1.63e-3,
            weight_strand_length=0.559,
            drive_strand_length=0.0,
            pulley_inertia=0.0,
            fibre_stiffness=104e3,
            fibre_damping=83.47,
        )
    return Setup(system=system)


def check(setup: Setup, where: str = "setup") -> Setup:
    """The setup itself, or InputError naming the first value that no stand can have."""
    names = SCALARS if setup.system is not System.LINEAR_DRIVE else ("moving_mass",)
    for name in names:
        value = getattr(setup, name)
        if value is None:
            if name == "moving_mass" and setup.system is System.LINEAR_DRIVE:
                raise InputError("missing", where=f"{where}/{name}", remedy="State the mass that moves, in kg")
            continue
        _check_value(name, value, where)
    return setup


def _check_value(name: str, value: float, where: str) -> None:
    if not math.isfinite(value):
        raise InputError("not a finite number", where=f"{where}/{name}", value=value, remedy="Measure or state it")
    if value < 0 or (value == 0 and name in _POSITIVE):
        raise InputError("must be positive", where=f"{where}/{name}", value=value, remedy=f"Give it in {SCALARS[name]}")
