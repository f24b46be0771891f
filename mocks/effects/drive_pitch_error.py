"""The drive's screw is periodically off: the fibre's end is not where the encoder on the motor says."""

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.stages import Screw
from mocks.plant.world import World


def act(world: World, amplitude: float, pitch: float, phase: float) -> None:
    """Puts the screw's error behind the encoder."""
    world.drive.append(Screw(amplitude, 2.0 * np.pi / pitch, phase))


EFFECT = Effect(
    "drive-pitch-error",
    "drive",
    (
        Size("amplitude", "m", 6e-05, 8e-06, 0.0002),
        Size("pitch", "m", 0.01, 0.005, 0.016, steady=True),
        Size("phase", "rad", 0.6, -3.1, 3.1, steady=True),
    ),
    act,
    depends_on=("drive_position",),
)
