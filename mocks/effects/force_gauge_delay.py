"""The force gauge reports the force late by a fixed time."""

from mocks.effects import Effect, Size
from mocks.plant.stages import Delay
from mocks.plant.world import World


def act(world: World, delay: float) -> None:
    """Puts a delay behind the force gauge."""
    if delay:
        world.sensors["fibre_force"].append(Delay(delay))


EFFECT = Effect(
    "force-gauge-delay",
    "force-gauge",
    (Size("delay", "s", 0.002, 5e-05, 0.004),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre", "linear-drive"),
)
