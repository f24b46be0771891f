"""The guide's dry friction is not what the operator believes."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, difference: float) -> None:
    """Changes the dry friction."""
    world.physics.friction += difference


EFFECT = Effect(
    "guide-coulomb-friction",
    "guide",
    (Size("difference", "N", 2.0, 0.3, 2.4, signed=True),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre", "linear-drive"),
)
