"""The mount gives way under the force: the fibre's end is at x - compliance (F - F at rest)."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, compliance: float) -> None:
    """Sets the mount's compliance."""
    world.physics.compliance = compliance


EFFECT = Effect(
    "drive-compliance",
    "drive",
    (Size("compliance", "m/N", 4e-06, 3e-07, 2e-05),),
    act,
)
