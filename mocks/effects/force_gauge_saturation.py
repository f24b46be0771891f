"""The force gauge reads no more than `level`."""

import math

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, level: float) -> None:
    """Clips the reading."""
    world.sensors["fibre_force"].append(lambda time, signal, truth: np.minimum(signal, level))


EFFECT = Effect(
    "force-gauge-saturation",
    "force-gauge",
    (Size("level", "N", 30.0, 24.0, 350.0, null=math.inf),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
