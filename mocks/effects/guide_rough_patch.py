"""Dry friction is larger on a stretch of the guide: + excess over `width` about `centre`, edges soft."""

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.physics import Tables
from mocks.plant.world import World


def act(world: World, excess: float, centre: float, width: float) -> None:
    """Adds the patch to the guide's friction over place."""
    distance = np.abs(Tables.PLACES - centre) / (0.5 * width)
    world.tables.patch += excess / (1.0 + np.exp(np.clip((distance - 1.0) / 0.06, -60.0, 60.0)))


EFFECT = Effect(
    "guide-rough-patch",
    "guide",
    (
        Size("excess", "N", 4.0, 0.4, 12.0),
        Size("centre", "m", 0.018, 0.012, 0.028, steady=True),
        Size("width", "m", 0.01, 0.005, 0.014, steady=True),
    ),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre", "linear-drive"),
)
