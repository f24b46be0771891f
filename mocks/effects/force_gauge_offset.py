"""The force gauge's zero is off."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, offset: float) -> None:
    """Adds the offset to the reading."""
    world.sensors["fibre_force"].append(lambda time, signal, truth: signal + offset)


EFFECT = Effect(
    "force-gauge-offset",
    "force-gauge",
    (Size("offset", "N", 2.0, 0.3, 5.0, signed=True),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre", "linear-drive"),
)
