"""The lubricant film drags most at one speed and lets go beyond it: force v/speed exp((1 - (v/speed)^2)/2)."""

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.physics import Tables
from mocks.plant.world import World


def act(world: World, force: float, speed: float) -> None:
    """Adds the film's drag to the guide's force over speed."""
    share = Tables.SPEEDS / speed
    world.tables.speed += force * share * np.exp(0.5 * (1.0 - share**2))


EFFECT = Effect(
    "guide-speed-bump",
    "guide",
    (
        Size("force", "N", 4.0, 0.3, 16.0),
        Size("speed", "m/s", 0.12, 0.08, 0.2, steady=True),
    ),
    act,
    depends_on=("weight_velocity",),
    systems=("weight-fibre-pulley-drive", "weight-fibre", "linear-drive"),
)
