"""Dry friction in the pulley's bearing: at the rim coefficient (T1 + T2) against its motion; it sticks at rest."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, coefficient: float) -> None:
    """Sets the bearing's coefficient."""
    world.physics.bearing = coefficient


EFFECT = Effect("pulley-bearing-friction", "pulley", (Size("coefficient", "-", 0.02, 0.001, 0.05),), act)
