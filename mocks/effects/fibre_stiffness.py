"""The fibre is stiffer or softer than the operator believes."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, difference: float) -> None:
    """Changes the whole fibre's stiffness."""
    world.physics.c += difference


EFFECT = Effect(
    "fibre-stiffness",
    "fibre",
    (Size("difference", "N/m", 10000.0, 1700.0, 17000.0, signed=True),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
