"""The fibre's stiffness grows with the weight's speed beyond a threshold: c + slope (|u'| - threshold)."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, slope: float, threshold: float) -> None:
    """Sets the slope and the threshold of the whole fibre's stiffness."""
    world.physics.c_slope, world.physics.c_threshold = slope, threshold


EFFECT = Effect(
    "velocity-dependent-stiffness",
    "fibre",
    (
        Size("slope", "N*s/m^2", 15000.0, 500.0, 40000.0),
        Size("threshold", "m/s", 0.2, 0.05, 0.25, steady=True),
    ),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
