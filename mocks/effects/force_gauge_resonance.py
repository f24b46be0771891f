"""The force gauge rings: a second-order response between the force and its reading."""

import math

from mocks.effects import Effect, Size
from mocks.plant.stages import resonance
from mocks.plant.world import World


def act(world: World, frequency: float, damping_ratio: float) -> None:
    """Puts the resonance behind the force gauge."""
    if math.isfinite(frequency):
        world.sensors["fibre_force"].append(resonance(frequency, damping_ratio))


EFFECT = Effect(
    "force-gauge-resonance",
    "force-gauge",
    (
        Size("frequency", "Hz", 120.0, 60.0, 700.0, null=math.inf),
        Size("damping_ratio", "-", 0.1, 0.03, 0.3, steady=True),
    ),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
