"""Internal dry friction of the tow: a rate-independent branch beside it (Bouc-Wen, n = 1), unloaded at rest."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, stiffness: float, yield_elongation: float) -> None:
    """Sets the branch of the whole fibre."""
    world.physics.hysteresis, world.physics.yield_elongation = stiffness, yield_elongation


EFFECT = Effect(
    "fibre-hysteresis",
    "fibre",
    (
        Size("stiffness", "N/m", 10000.0, 500.0, 40000.0),
        Size("yield_elongation", "m", 0.0003, 0.0001, 0.0005, steady=True),
    ),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
