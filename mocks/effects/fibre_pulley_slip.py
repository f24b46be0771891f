"""The fibre slides on the rim where T_hi/T_lo reaches exp(friction wrap) (Euler, Eytelwein)."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, friction: float) -> None:
    """Sets the friction at which it slides; 0 means that it never does."""
    world.physics.slip = friction


EFFECT = Effect(
    "fibre-pulley-slip",
    "pulley",
    (Size("friction", "-", 0.15, 0.02, 0.4, null=0.0),),
    act,
)
