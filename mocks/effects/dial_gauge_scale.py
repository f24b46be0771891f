"""The dial gauge reads gain times the weight's position."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, gain: float) -> None:
    """Scales the reading."""
    world.sensors["weight_position"].append(lambda time, signal, truth: gain * signal)


EFFECT = Effect(
    "dial-gauge-scale",
    "dial-gauge",
    (Size("gain", "-", 1.01, 1.0005, 1.05, null=1.0),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
