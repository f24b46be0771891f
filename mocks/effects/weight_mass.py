"""The weight is heavier or lighter than the operator believes."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, difference: float) -> None:
    """Changes the mass and the tension that holds it at rest."""
    physics = world.physics
    physics.mass += difference
    physics.rest_tension = physics.mass * physics.gravity_along


EFFECT = Effect(
    "weight-mass",
    "weight",
    (Size("difference", "kg", 0.25, 0.03, 0.5, signed=True),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
