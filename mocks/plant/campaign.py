"""Six runs of 10 s that together excite a stand: slow, gentle, snatching, rectangular, with the added mass."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from mocks.effects import Value
from mocks.plant.motion import ADDED, Motion
from mocks.plant.operator import Stand

RUNS = 6


def draw_motions(seed: int | np.random.Generator) -> list[Motion]:
    """Six motions: slow sine, trapezoid without and with snatches (above 0.4 m/s), rectangle, two loaded."""
    rng = np.random.default_rng(seed)

    def between(low: float, high: float) -> float:
        return float(rng.uniform(low, high))

    ramp = between(0.19, 0.21)
    loaded = between(0.18, 0.22)
    return [
        Motion("quasi-sinusoidal", between(0.30, 0.40), between(0.070, 0.090)),
        Motion("trapezoidal", between(0.9, 1.25), between(0.035, 0.042), between(0.32, 0.38)),
        Motion("trapezoidal", between(1.25, 1.75), between(10.5, 11.8) * ramp**2 / 8.0, ramp),
        Motion("rectangular", between(0.8, 1.1), between(0.030, 0.050)),
        Motion("trapezoidal", between(1.0, 1.25), between(4.0, 6.0) * loaded**2 / 8.0, loaded, ADDED),
        Motion("quasi-sinusoidal", between(1.2, 1.6), between(0.045, 0.055), 0.0, ADDED),
    ]


def write_campaign(
    folder: Path, stand: Stand, seed: int, hidden: Mapping[str, Mapping[str, Value]], seconds: float = 10.0
) -> list[Path]:
    """run-1.h5 ... run-6.h5 with their truths in `folder`, from one seed."""
    from mocks.record import record

    folder.mkdir(parents=True, exist_ok=True)
    motions = draw_motions(np.random.default_rng([seed, 1]))
    return [
        record(stand, motion, path=folder / f"run-{k}.h5", seconds=seconds, seed=seed * RUNS + k, hidden=hidden)
        for k, motion in enumerate(motions, 1)
    ]
