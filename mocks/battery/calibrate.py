"""How strongly each effect shows over its range of sizes: `python -m mocks.battery.calibrate >> FILE`.

The table lets a battery draw sizes for wanted strengths; it holds for the nominal stand and one campaign, so a drawn
strength is near the wanted one, not exact.
"""

from __future__ import annotations

import json
import sys

import numpy as np

from mocks.battery.strength import strength
from mocks.effects import Effect, Size, everything
from mocks.plant.campaign import draw_motions
from mocks.plant.operator import draw_stand

POINTS, WINDOWS, SECONDS = 2, 6, 5.0
RUNS = (1, 2, 4)  # of a campaign: gentle, snatching, loaded


def main_size(effect: Effect) -> Size:
    """The parameter whose size makes the effect strong or weak."""
    return next(size for size in effect.sizes if not size.steady and not size.choices)


def ladder(size: Size) -> list[float]:
    """POINTS sizes well within the range, even in the logarithm of the distance from the null where it is finite."""
    null = size.null if np.isfinite(size.null) else 0.0
    return [null + float(d) for d in np.geomspace(size.low - null, size.high - null, 2 * POINTS + 1)[1::2]]


def main() -> int:
    """One line of JSON per effect: {"name": [[size, strength], ...]}."""
    stand, motions = draw_stand(0, errors=0.0), [draw_motions(0)[k] for k in RUNS]
    for effect in everything():
        if sys.argv[1:] and effect.name not in sys.argv[1:]:
            continue
        size = main_size(effect)
        measured = [
            [value, round(strength(stand, {effect.name: {size.name: value}}, motions, SECONDS, WINDOWS), 3)]
            for value in ladder(size)
        ]
        print(json.dumps({effect.name: measured}), flush=True)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
