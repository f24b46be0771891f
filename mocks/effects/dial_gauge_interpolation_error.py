"""The dial gauge's scale is periodically off."""

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, amplitude: float, pitch: float, phase: float) -> None:
    """Adds the scale's error to the reading."""
    k = 2.0 * np.pi / pitch
    zero = amplitude * np.sin(phase)
    world.sensors["weight_position"].append(
        lambda time, signal, truth: signal + amplitude * np.sin(k * signal + phase) - zero
    )


EFFECT = Effect(
    "dial-gauge-interpolation-error",
    "dial-gauge",
    (
        Size("amplitude", "m", 5e-05, 8e-06, 0.0002),
        Size("pitch", "m", 0.008, 0.004, 0.012, steady=True),
        Size("phase", "rad", 0.9, -3.1, 3.1, steady=True),
    ),
    act,
    depends_on=("weight_position",),
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
