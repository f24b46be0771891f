"""A spring and a dashpot in series lie beside the fibre (Maxwell branch), relaxed at rest."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, stiffness: float, time_constant: float) -> None:
    """Sets the branch of the whole fibre."""
    world.physics.maxwell, world.physics.maxwell_time = stiffness, time_constant


EFFECT = Effect(
    "fibre-viscoelasticity",
    "fibre",
    (
        Size("stiffness", "N/m", 10000.0, 500.0, 40000.0),
        Size("time_constant", "s", 0.05, 0.02, 0.2, steady=True),
    ),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
