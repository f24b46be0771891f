"""The rig without pulley: the weight is lifted by hand, let go, and caught by its fibre."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from mocks.plant import march
from mocks.plant.motion import REST
from mocks.plant.plant import GRID, Plant, Slice
from mocks.plant.rig import Rig

Float = NDArray[np.float64]

LIFT, HOLD = 0.6, 0.4  # s that the hand takes to lift the weight, and holds it


def release(
    rig: Rig, drop_height: float, seconds: float, hidden: Mapping[str, Mapping[str, float | str]] | None = None
) -> tuple[Plant, Slice]:
    """A run: 1 s of rest, the lift to drop_height m, the release at REST + LIFT + HOLD, and what follows.

    The hand carries the weight's whole load until it opens; the fibre is slack then. ValueError where the run is
    too short for the fall.
    """
    if seconds < 2.0 * REST + LIFT + HOLD + 0.5:
        raise ValueError(f"{seconds} s are too short for a release")
    plant = Plant(rig, hidden)
    held = _by_hand(plant, drop_height)
    fallen = plant.fall(drop_height, round(seconds / GRID) - len(held))
    truth = np.concatenate([held, fallen])
    time = np.linspace(GRID, len(truth) * GRID, len(truth))
    return plant, plant.sense(time, truth[:, 0], truth)


def _by_hand(plant: Plant, height: float) -> Float:
    """Truth at rest, during the lift and while it is held, float64 [n, 11]."""
    time = (np.arange(round((REST + LIFT + HOLD) / GRID)) + 1.0) * GRID
    share = np.clip((time - REST) / LIFT, 0.0, 1.0)
    u = height * (10.0 * share**3 - 15.0 * share**4 + 6.0 * share**5)
    truth = np.zeros((len(time), len(march.COLUMNS)))
    physics = plant.world.physics
    truth[:, 2], truth[:, 3] = u, np.gradient(u, GRID)
    stretch = np.maximum(physics.rest_stretch - u, 0.0)
    truth[:, 6] = truth[:, 7] = physics.c * stretch * (1.0 + physics.hardening * stretch)
    return truth
