"""The pulley is heavier to turn than the operator believes."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, difference: float) -> None:
    """Changes the pulley's inertia."""
    world.physics.rim_mass += difference / world.physics.radius**2


EFFECT = Effect(
    "pulley-inertia",
    "pulley",
    (Size("difference", "kg*m^2", 0.00015, 2e-05, 0.0003),),
    act,
)
