"""The dial gauge's lead pulls taut where the weight is high: a force with the square of the way beyond `reach`."""

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.physics import Tables
from mocks.plant.world import World


def act(world: World, force: float, reach: float) -> None:
    """Adds the lead's pull to the guide's force over place; `force` 15 mm beyond."""
    beyond = np.maximum(Tables.PLACES - reach, 0.0)
    world.tables.guide += force * np.minimum(beyond / 0.015, 4.0) ** 2


EFFECT = Effect(
    "sensor-cable-drag",
    "guide",
    (
        Size("force", "N", 4.0, 0.05, 6.0),
        Size("reach", "m", 0.02, 0.012, 0.028, steady=True),
    ),
    act,
    depends_on=("weight_position",),
)
