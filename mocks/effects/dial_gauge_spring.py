"""The dial gauge's plunger pushes on the weight as a spring, zero at rest."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, stiffness: float) -> None:
    """Sets the spring."""
    world.physics.spring += stiffness


EFFECT = Effect(
    "dial-gauge-spring",
    "weight",
    (Size("stiffness", "N/m", 80.0, 5.0, 300.0),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
