"""Dry friction higher by `excess` where |u - centre| < width/2."""

from __future__ import annotations

import math
from collections.abc import Sequence

from twin.causes._kind import GUIDE, Cause, Survey, Values, dynamics, grid
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _friction(q, p):  # type: ignore[no-untyped-def]
    edge = 0.045 * p[3]
    away = abs(q[k.U] - p[2]) - 0.5 * p[3]
    if away < 4.0 * edge:
        q[k.FRICTION] += p[1] * 0.5 * (1.0 - math.tanh(away / edge))


def _scan(survey: Survey) -> Sequence[Values]:
    low, high = survey.often
    span = high - low
    points = []
    for width in (span / 4, span / 9):
        count = max(3, round(1.5 * span / width))
        centres = [low + (i + 0.5) * span / count for i in range(count)]
        points += grid({"excess": 3.0}, centre=centres, width=(width,))
    return points


guide_rough_patch = Cause(
    name="guide-rough-patch",
    title="a rough place in the guide",
    acts_on="guide",
    parameters=(
        Parameter("excess", "N", 0.0, (0.0, 200.0), 3.0, "friction beyond F_c within the patch"),
        Parameter("centre", "m", 0.01, (-0.5, 0.5), 0.02, "place of its middle"),
        Parameter("width", "m", 0.01, (0.001, 0.3), 0.01, "its whole width"),
    ),
    source=Source("assumed"),
    after=_friction,
    scan=_scan,
    rivals=("guide-coulomb-friction", "end-stop"),
    systems=GUIDE,
)
