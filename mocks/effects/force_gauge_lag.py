"""The force gauge follows the force as a first-order low-pass."""

from mocks.effects import Effect, Size
from mocks.plant.stages import lag
from mocks.plant.world import World


def act(world: World, time_constant: float) -> None:
    """Puts a lag behind the force gauge."""
    if time_constant:
        world.sensors["fibre_force"].append(lag(time_constant))


EFFECT = Effect(
    "force-gauge-lag",
    "force-gauge",
    (Size("time_constant", "s", 3e-3, 1e-4, 6e-3),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
