"""The dial gauge reports the weight's position late by a fixed time."""

from mocks.effects import Effect, Size
from mocks.plant.stages import Delay
from mocks.plant.world import World


def act(world: World, delay: float) -> None:
    """Puts a delay behind the dial gauge."""
    if delay:
        world.sensors["weight_position"].append(Delay(delay))


EFFECT = Effect(
    "dial-gauge-delay",
    "dial-gauge",
    (Size("delay", "s", 2e-3, 5e-5, 4e-3),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
