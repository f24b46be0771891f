"""The guide's dry friction fades as the stand warms up, from run start on."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, fade: float, time_constant: float) -> None:
    """Sets the share that fades and how fast."""
    world.physics.fade, world.physics.fade_time = fade, time_constant


EFFECT = Effect(
    "friction-fade",
    "guide",
    (
        Size("fade", "-", 0.5, 0.15, 0.8),
        Size("time_constant", "s", 4.0, 2.0, 8.0, steady=True),
    ),
    act,
    depends_on=("time",),
)
