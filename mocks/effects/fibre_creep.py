"""The fibre yields slowly under load: a Kelvin-Voigt element in series, settled at rest."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, compliance: float, time_constant: float) -> None:
    """Sets the element of the whole fibre."""
    world.physics.creep, world.physics.creep_time = compliance, time_constant


EFFECT = Effect(
    "fibre-creep",
    "fibre",
    (
        Size("compliance", "m/N", 2e-05, 2e-06, 0.0001),
        Size("time_constant", "s", 0.6, 0.2, 2.0, steady=True),
    ),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
