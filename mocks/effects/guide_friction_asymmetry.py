"""Dry friction differs by direction; difference is up minus down, the mean stays."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, difference: float) -> None:
    """Sets the difference."""
    world.physics.asymmetry = difference


EFFECT = Effect(
    "guide-friction-asymmetry",
    "guide",
    (Size("difference", "N", 1.5, 0.1, 4.0, signed=True),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre", "linear-drive"),
)
