"""The force gauge reads gain times the force."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, gain: float) -> None:
    """Scales the reading."""
    world.sensors["fibre_force"].append(lambda time, signal, truth: gain * signal)


EFFECT = Effect(
    "force-gauge-scale",
    "force-gauge",
    (Size("gain", "-", 1.06, 1.01, 1.15, null=1.0),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
