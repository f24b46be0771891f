"""The dial gauge's plunger sticks: its reading follows with a dead band of `width` as a whole."""

from mocks.effects import Effect, Size
from mocks.plant.stages import Play
from mocks.plant.world import World


def act(world: World, width: float) -> None:
    """Puts a play behind the dial gauge."""
    if width:
        world.sensors["weight_position"].append(Play(width))


EFFECT = Effect(
    "dial-gauge-sticking",
    "dial-gauge",
    (Size("width", "m", 0.0001, 1e-05, 0.0004),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
