"""An end stop stands where it should not: the weight strikes it (null: out of reach)."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, position: float) -> None:
    """Moves the upper stop, or for a negative position the lower one; 0 leaves both."""
    if position > 0.0:
        world.physics.stop_high = position
    elif position < 0.0:
        world.physics.stop_low = position


EFFECT = Effect(
    "end-stop",
    "guide",
    (Size("position", "m", 0.024, 0.02, 0.12),),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
