"""The fibre's end follows the recorded drive position late by a fixed time."""

from mocks.effects import Effect, Size
from mocks.plant.stages import Delay
from mocks.plant.world import World


def act(world: World, delay: float) -> None:
    """Puts a delay behind the encoder."""
    if delay:
        world.drive.append(Delay(delay))


EFFECT = Effect(
    "drive-delay",
    "drive",
    (Size("delay", "s", 0.002, 5e-05, 0.004),),
    act,
)
