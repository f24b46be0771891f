"""The dial gauge reads no more than `level` above the rest."""

import math

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, level: float) -> None:
    """Clips the reading."""
    world.sensors["weight_position"].append(lambda time, signal, truth: np.minimum(signal, level))


EFFECT = Effect(
    "dial-gauge-saturation",
    "dial-gauge",
    (Size("level", "m", 0.026, 0.02, 0.09, null=math.inf),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
