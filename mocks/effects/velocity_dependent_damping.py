"""The fibre's damping grows with the weight's speed beyond a threshold: b + slope (|u'| - threshold)."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, slope: float, threshold: float) -> None:
    """Sets the slope and the threshold of the whole fibre's damping."""
    world.physics.b_slope, world.physics.b_threshold = slope, threshold


EFFECT = Effect(
    "velocity-dependent-damping",
    "fibre",
    (Size("slope", "N*s^2/m^2", 385.0, 20.0, 600.0), Size("threshold", "m/s", 0.4, 0.15, 0.45, steady=True)),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
