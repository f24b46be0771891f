"""The fibre pulls askew and presses the weight on its guide: dry friction grows with (T - T at rest)^2."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, coefficient: float) -> None:
    """Sets N of friction per N^2."""
    world.physics.load_friction = coefficient


EFFECT = Effect(
    "guide-load-friction",
    "guide",
    (Size("coefficient", "1/N", 0.0004, 5e-05, 0.0015),),
    act,
    depends_on=("fibre_force",),
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
