"""The dial gauge follows the weight as a first-order low-pass."""

from mocks.effects import Effect, Size
from mocks.plant.stages import lag
from mocks.plant.world import World


def act(world: World, time_constant: float) -> None:
    """Puts a lag behind the dial gauge."""
    if time_constant:
        world.sensors["weight_position"].append(lag(time_constant))


EFFECT = Effect(
    "dial-gauge-lag",
    "dial-gauge",
    (Size("time_constant", "s", 0.003, 0.0001, 0.006),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
