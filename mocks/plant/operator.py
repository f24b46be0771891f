"""The operator: what is believed of a stand, how surely, and what is true of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mocks.plant.rig import LINEAR_DRIVE, WF, Rig

#: one sigma as a share of the value; angles in rad, gravity and lengths as measured
SHARES = {
    "weight_mass": 0.01,
    "added_mass": 0.01,
    "weight_strand_length": 0.01,
    "drive_strand_length": 0.01,
    "pulley_radius": 0.01,
    "pulley_inertia": 0.10,
    "fibre_length": 0.01,
    "fibre_mass": 0.02,
    "fibre_stiffness": 0.05,
    "fibre_damping": 0.10,
    "guide_friction": 0.10,
    "guide_friction_velocity": 0.10,
    "wrap_angle": 0.01,
    "moving_mass": 0.02,
}
ANGLE, GRAVITY = math.radians(0.3), 0.002
SCALES = 1e-3  # kg that the scales are sure of at best
BOUND = 2.0  # sigmas that an operator is off at most
#: a hidden difference is one from the operator's value, which then has no other error
BASE = {
    "fibre-stiffness": "fibre_stiffness",
    "fibre-damping": "fibre_damping",
    "pulley-inertia": "pulley_inertia",
    "guide-coulomb-friction": "guide_friction",
    "weight-mass": "weight_mass",
    "incline-angle": "incline_angle",
}


@dataclass(frozen=True)
class Stand:
    """believed: what the setup states. uncertainty: one sigma in SI for each value stated. true: what the plant has."""

    believed: Rig
    true: Rig
    uncertainty: Mapping[str, float]

    def with_mass(self, added: float) -> Stand:
        """The same stand with a mass added, true and believed off by the same share as the first one."""
        off = self.true.added_mass / self.believed.added_mass if self.believed.added_mass else self.added_share
        sigmas = dict(self.uncertainty) | {"added_mass": max(SHARES["added_mass"] * added, SCALES)}
        return Stand(self.believed.but(added_mass=added), self.true.but(added_mass=added * off), sigmas)

    @property
    def added_share(self) -> float:
        """How far off a mass that is added would be: as the weight is, from the same scales."""
        return self.true.weight_mass / self.believed.weight_mass

    def hiding(self, names: Mapping[str, object]) -> Rig:
        """The true rig for a plant that hides these effects: a base parameter's difference starts at the belief."""
        exact = {BASE[name]: getattr(self.believed, BASE[name]) for name in names if name in BASE}
        return self.true.but(**exact)


def sigmas(rig: Rig, scale: float = 1.0) -> dict[str, float]:
    """One sigma in SI for every value that the setup of such a rig states."""
    if rig.system == LINEAR_DRIVE:
        return {"moving_mass": scale * SHARES["moving_mass"] * rig.moving_mass}
    stated = {name: scale * share * getattr(rig, name) for name, share in SHARES.items() if name != "moving_mass"}
    if rig.system == WF:
        stated = {k: v for k, v in stated.items() if k.split("_")[0] not in ("pulley", "drive", "wrap")}
    return stated | {"incline_angle": scale * ANGLE, "gravity": GRAVITY}


def draw_stand(seed: int | np.random.Generator, believed: Rig | None = None, *, errors: float = 1.0) -> Stand:
    """A stand whose true values are off the believed ones by up to 2 sigma; errors = 0: the belief is exact."""
    rng = np.random.default_rng(seed)
    believed = believed or Rig()
    uncertainty = sigmas(believed)
    true = {n: getattr(believed, n) + errors * s * _within(rng) for n, s in sorted(uncertainty.items())}
    return Stand(believed, believed.but(**true), uncertainty)


def _within(rng: np.random.Generator) -> float:
    """A standard normal number within BOUND."""
    while True:
        number = float(rng.standard_normal())
        if abs(number) <= BOUND:
            return number
