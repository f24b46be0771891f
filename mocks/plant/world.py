"""A stand with what is hidden in it: constants, tables, stages on the drive and on the sensors, clocks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mocks.plant.physics import Physics, Tables, no_tables, physics
from mocks.plant.rig import Rig
from mocks.plant.stages import DriveStage, Stage

FASTEST = 2.0  # m/s that a weight reaches
CHANNELS = ("drive_position", "weight_position", "fibre_force")


@dataclass
class World:
    """What a hidden effect may change.

    clocks: instrument -> rate by which its clock runs fast. drive: stages between the encoder and the fibre's end.
    sensors: channel -> stages between the truth and what the instrument reads.
    """

    rig: Rig
    physics: Physics
    tables: Tables = field(default_factory=no_tables)
    drive: list[DriveStage] = field(default_factory=list)
    sensors: dict[str, list[Stage]] = field(default_factory=lambda: {name: [] for name in CHANNELS})
    clocks: dict[str, float] = field(default_factory=dict)

    @classmethod
    def of(cls, rig: Rig, hidden: Mapping[str, Mapping[str, float | str]]) -> World:
        """The rig's world with every named effect at work; KeyError or ValueError for a wrong name or parameter."""
        from mocks.effects import find

        world = cls(rig, physics(rig))
        for name, values in hidden.items():
            effect = find(name)
            effect.act(world, **effect.complete(values))
        return world

    def record(self) -> NDArray[np.void]:
        """The constants for the kernel, the step small enough for the stiffest part."""
        p = self.physics
        p.tables = float(any(np.any(t) for t in self.tables.packed()))
        p.step = min(p.step, 1.5 / self._fastest_rate())
        return p.record()

    def _fastest_rate(self) -> float:
        """1/s of the stiffest part, rim or drive's mount (Runge-Kutta bears 2.7 a step)."""
        p, rate = self.physics, 1.0
        if p.rim_mass > 0.0 and not p.locked:
            damping = p.b + p.b_slope * max(0.0, FASTEST - p.b_threshold)
            rate = max(rate, damping * (p.share1 + p.share2) / p.rim_mass)
        if p.compliance > 0.0:
            rate = max(rate, (p.c * p.share2 + 1.0 / p.compliance) / (p.b * p.share2))
        return rate

    def state_size(self) -> int:
        """How many of the kernel's states move."""
        p = self.physics
        if p.maxwell or p.hysteresis or p.creep:
            return 12
        return 6 if p.slip or p.compliance else 4
