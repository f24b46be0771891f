"""The force gauge's cable bends as the drive travels: its zero follows the square of the drive's position."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, force: float) -> None:
    """Adds the cable's error to the reading; `force` at 30 mm."""
    world.sensors["fibre_force"].append(lambda time, signal, truth: signal + force * (truth[:, 0] / 0.03) ** 2)


EFFECT = Effect(
    "force-gauge-cable",
    "force-gauge",
    (Size("force", "N", 1.5, 0.2, 4.0),),
    act,
    depends_on=("drive_position",),
)
