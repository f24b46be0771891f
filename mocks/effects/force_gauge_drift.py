"""The force gauge's zero drifts from the start on."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, rate: float) -> None:
    """Adds the drift to the reading."""
    world.sensors["fibre_force"].append(lambda time, signal, truth: signal + rate * time)


EFFECT = Effect(
    "force-gauge-drift",
    "force-gauge",
    (Size("rate", "N/s", 0.5, 0.02, 2.0, signed=True),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
