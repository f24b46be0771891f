"""The fibre's end moves gain times as far as the encoder says."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, gain: float) -> None:
    """Puts a gain behind the encoder."""
    world.drive.append(lambda time, path: gain * path)


EFFECT = Effect(
    "drive-scale",
    "drive",
    (Size("gain", "-", 1.01, 1.0005, 1.05, null=1.0),),
    act,
)
