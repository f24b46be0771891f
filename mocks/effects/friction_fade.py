"""A cold guide rubs more: its dry friction has an excess at the run's start that fades as the stand warms up."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, excess: float, time_constant: float) -> None:
    """Sets the excess and how fast it fades."""
    world.physics.fade, world.physics.fade_time = excess, time_constant


EFFECT = Effect(
    "friction-fade",
    "guide",
    (
        Size("excess", "N", 4.0, 0.4, 16.0),
        Size("time_constant", "s", 4.0, 2.0, 8.0, steady=True),
    ),
    act,
    depends_on=("time",),
)
