"""An effect that is drawn with either sign turns round with it."""

from __future__ import annotations

import numpy as np
import pytest

from mocks import effects
from mocks.effects import Size
from mocks.plant.motion import Motion, targets
from mocks.plant.plant import GRID, Plant, Slice
from mocks.plant.rig import Rig

CLOCKS = "clock-drift"  # nothing of it is in the plant's own signals


def _signed(name: str) -> Size | None:
    return next((s for s in effects.find(name).sizes if s.signed and not s.steady), None)


SIGNED = [name for name in effects.names() if _signed(name) is not None]


def _plants(name: str) -> tuple[Plant, Plant]:
    """With a size either way of null, small enough to be nearly linear."""
    size = _signed(name)
    assert size is not None
    small = 0.2 * (float(size.default) - size.null)
    one, other = (Plant(Rig(), {name: {size.name: size.null + by}}) for by in (small, -small))
    return one, other


@pytest.mark.parametrize("name", [name for name in SIGNED if name != CLOCKS])
def test_a_signed_effect_turns_round_with_its_sign(name: str) -> None:
    path = targets(Motion("trapezoidal", 1.0, 0.040, 0.35), 3.0, GRID)
    plain = Plant(Rig()).follow(path)

    def change(out: Slice) -> np.ndarray:
        return np.concatenate([(out.x - plain.x) / 1e-6, (out.u - plain.u) / 6e-6, (out.F - plain.F) / 0.12])

    one, other = (change(plant.follow(path)) for plant in _plants(name))
    assert one @ other < -0.5 * np.linalg.norm(one) * np.linalg.norm(other)


def test_a_clock_drifts_the_other_way_with_its_sign() -> None:
    one, other = (plant.world.clocks for plant in _plants(CLOCKS))
    assert one
    assert all(one[name] * other[name] < 0 for name in one)
