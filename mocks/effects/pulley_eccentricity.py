"""The pulley runs out of true: the weight strand gains amplitude (sin(s/r + phase) - sin(phase))."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, amplitude: float, phase: float) -> None:
    """Sets the run-out; the rim's lever of T1 follows from the work done."""
    world.physics.eccentricity, world.physics.eccentric_phase = amplitude, phase


EFFECT = Effect(
    "pulley-eccentricity",
    "pulley",
    (
        Size("amplitude", "m", 0.0003, 1e-05, 0.0015),
        Size("phase", "rad", 0.8, -3.1, 3.1, steady=True),
    ),
    act,
)
