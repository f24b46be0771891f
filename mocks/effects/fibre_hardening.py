"""The fibre stiffens as it stretches: T = c d (1 + coefficient d), d of the whole fibre."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, coefficient: float) -> None:
    """Sets the coefficient; the rest stretch follows from it."""
    world.physics.hardening = coefficient


EFFECT = Effect(
    "fibre-hardening",
    "fibre",
    (Size("coefficient", "1/m", 30.0, 1.0, 60.0),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
