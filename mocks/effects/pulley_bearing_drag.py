"""A force at the rim in proportion to its speed."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, coefficient: float) -> None:
    """Sets the drag at the rim."""
    world.physics.rim_drag += coefficient


EFFECT = Effect(
    "pulley-bearing-drag",
    "pulley",
    (Size("coefficient", "N*s/m", 5.0, 0.5, 20.0),),
    act,
)
