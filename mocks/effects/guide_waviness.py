"""The guide is wavy: its dry friction rises and falls with the weight's position."""

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.physics import Tables
from mocks.plant.world import World


def act(world: World, amplitude: float, pitch: float, phase: float) -> None:
    """Adds the waves to the guide's friction over place."""
    world.tables.patch += amplitude * (1.0 + np.sin(2.0 * np.pi * Tables.PLACES / pitch + phase))


EFFECT = Effect(
    "guide-waviness",
    "guide",
    (
        Size("amplitude", "N", 2.0, 0.3, 8.0),
        Size("pitch", "m", 0.016, 0.01, 0.025, steady=True),
        Size("phase", "rad", 1.0, -3.1, 3.1, steady=True),
    ),
    act,
    depends_on=("weight_position",),
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
