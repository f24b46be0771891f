"""Magnets under the guide hold the weight at regular places: a force periodic in its position."""

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.physics import Tables
from mocks.plant.world import World


def act(world: World, amplitude: float, pitch: float, phase: float) -> None:
    """Adds the cogging to the guide's force over place."""
    world.tables.guide += amplitude * (np.sin(2.0 * np.pi * Tables.PLACES / pitch + phase) - np.sin(phase))


EFFECT = Effect(
    "guide-cogging",
    "guide",
    (
        Size("amplitude", "N", 2.0, 0.3, 8.0),
        Size("pitch", "m", 0.012, 0.008, 0.02, steady=True),
        Size("phase", "rad", 0.5, -3.1, 3.1, steady=True),
    ),
    act,
    depends_on=("weight_position",),
    systems=("weight-fibre-pulley-drive", "weight-fibre", "linear-drive"),
)
