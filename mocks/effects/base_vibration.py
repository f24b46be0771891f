"""The base shakes along the incline at one frequency, from a machine next door."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, acceleration: float, frequency: float, phase: float) -> None:
    """Sets the base's acceleration."""
    physics = world.physics
    physics.shake, physics.shake_frequency, physics.shake_phase = acceleration, frequency, phase


EFFECT = Effect(
    "base-vibration",
    "weight",
    (
        Size("acceleration", "m/s^2", 0.5, 0.05, 1.2),
        Size("frequency", "Hz", 23.0, 9.0, 45.0, steady=True),
        Size("phase", "rad", 0.3, -3.1, 3.1, steady=True),
    ),
    act,
    depends_on=("frequency", "time"),
)
