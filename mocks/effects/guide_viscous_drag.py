"""A force on the weight in proportion to its speed."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, coefficient: float) -> None:
    """Adds to the guide's viscous coefficient."""
    world.physics.viscous += coefficient


EFFECT = Effect(
    "guide-viscous-drag",
    "guide",
    (Size("coefficient", "N*s/m", 8.0, 0.5, 20.0),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre", "linear-drive"),
)
