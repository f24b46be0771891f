"""One instrument's clock runs fast by `rate` (1e-6 is 1 ppm): what it dates t happened at t/(1 + rate)."""

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, rate: float, instrument: str) -> None:
    """Sets the instrument's clock."""
    world.clocks[instrument] = world.clocks.get(instrument, 0.0) + rate


EFFECT = Effect(
    "clock-drift",
    "timing",
    (
        Size("rate", "-", 0.0001, 1e-05, 0.0006, signed=True),
        Size("instrument", "", "force_gauge", choices=("force_gauge", "dial_gauge", "drive")),
    ),
    act,
)
