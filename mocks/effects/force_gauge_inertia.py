"""Part of the force gauge moves with the drive: its reading has mass x'' in it."""

from mocks.effects import Effect, Size
from mocks.plant.stages import Inertia
from mocks.plant.world import World


def act(world: World, mass: float) -> None:
    """Adds the mass's force to the reading."""
    if mass:
        world.sensors["fibre_force"].append(Inertia(mass))


EFFECT = Effect(
    "force-gauge-inertia",
    "force-gauge",
    (Size("mass", "kg", 0.4, 0.03, 2.0),),
    act,
)
