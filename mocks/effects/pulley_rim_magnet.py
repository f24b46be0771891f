"""Magnets of an old encoder hold the pulley at regular angles: a force at the rim periodic in its angle."""

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.physics import Tables
from mocks.plant.world import World


def act(world: World, force: float, poles: float, phase: float) -> None:
    """Adds the magnets' force at the rim over its displacement."""
    angle = Tables.PLACES / world.physics.radius
    world.tables.rim += force * (np.sin(poles * angle + phase) - np.sin(phase))


EFFECT = Effect(
    "pulley-rim-magnet",
    "pulley",
    (
        Size("force", "N", 2.0, 0.1, 6.0),
        Size("poles", "-", 24.0, 16.0, 40.0, steady=True),
        Size("phase", "rad", 0.7, -3.1, 3.1, steady=True),
    ),
    act,
    depends_on=("pulley_angle", "drive_position", "weight_position"),
)
