"""A stand with what is hidden in it: constants, tables, stages on the drive and on the sensors, clocks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mocks.plant.physics import Physics, Tables, no_tables, physics
from mocks.plant.rig import Rig
from mocks.plant.stages import DriveStage, Stage

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
        if p.compliance > 0.0:
            p.step = min(p.step, p.b * p.share2 / (p.c * p.share2 + 1.0 / p.compliance))
        return p.record()

    def state_size(self) -> int:
        """How many of the kernel's states move."""
        p = self.physics
        if p.maxwell or p.hysteresis or p.creep:
            return 12
        return 6 if p.slip or p.compliance else 4
