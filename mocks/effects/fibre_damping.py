"""The fibre damps more or less than the operator believes."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, difference: float) -> None:
    """Changes the whole fibre's damping."""
    world.physics.b += difference


EFFECT = Effect(
    "fibre-damping",
    "fibre",
    (Size("difference", "N*s/m", 15.0, 2.0, 22.0, signed=True),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
