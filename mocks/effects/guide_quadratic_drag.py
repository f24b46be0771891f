"""A force on the weight in proportion to its speed squared."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, coefficient: float) -> None:
    """Sets the coefficient."""
    world.physics.quadratic += coefficient


EFFECT = Effect(
    "guide-quadratic-drag",
    "guide",
    (Size("coefficient", "N*s^2/m^2", 15.0, 1.0, 40.0),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre", "linear-drive"),
)
