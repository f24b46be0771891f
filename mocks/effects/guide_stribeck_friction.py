"""Dry friction is larger at low speed: + excess exp(-(v/velocity)^2)."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, excess: float, velocity: float) -> None:
    """Sets the excess and its speed."""
    world.physics.stribeck, world.physics.stribeck_velocity = excess, velocity


EFFECT = Effect(
    "guide-stribeck-friction",
    "guide",
    (
        Size("excess", "N", 4.0, 0.3, 16.0),
        Size("velocity", "m/s", 0.03, 0.01, 0.08, steady=True),
    ),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre", "linear-drive"),
)
