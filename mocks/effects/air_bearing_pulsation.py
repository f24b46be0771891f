"""The guide's air supply pulses and its dry friction with it, at one frequency."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, share: float, frequency: float, phase: float) -> None:
    """Sets the share of the friction that pulses."""
    physics = world.physics
    physics.pulse, physics.pulse_frequency, physics.pulse_phase = share, frequency, phase


EFFECT = Effect(
    "air-bearing-pulsation",
    "guide",
    (
        Size("share", "-", 0.5, 0.08, 0.8),
        Size("frequency", "Hz", 0.6, 0.3, 3.0, steady=True),
        Size("phase", "rad", 0.2, -3.1, 3.1, steady=True),
    ),
    act,
    depends_on=("time", "frequency"),
)
