"""The guide is steeper or flatter than the operator believes."""

import math

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, difference: float) -> None:
    """Changes the incline and the tension that holds the weight at rest."""
    physics = world.physics
    angle = world.rig.incline_angle + math.radians(difference)
    physics.gravity_along = world.rig.gravity * math.sin(angle)
    physics.rest_tension = physics.mass * physics.gravity_along


EFFECT = Effect(
    "incline-angle",
    "weight",
    (Size("difference", "deg", 2.0, 0.3, 5.0, signed=True),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
