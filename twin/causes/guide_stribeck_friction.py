"""Stribeck friction: F_c + excess exp(-(v/velocity)^2) in the direction of motion."""

from __future__ import annotations

import math
from collections.abc import Sequence

from twin.causes._kind import GUIDE, Cause, Survey, Values, dynamics, grid
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _friction(q, p):  # type: ignore[no-untyped-def]
    ratio = q[k.V] / p[2]
    if abs(ratio) < 6.0:
        q[k.FRICTION] += p[1] * math.exp(-ratio * ratio)


def _scan(survey: Survey) -> Sequence[Values]:
    return grid({"excess": 2.0}, velocity=(0.01, 0.03, 0.08, 0.2))


guide_stribeck_friction = Cause(
    name="guide-stribeck-friction",
    title="friction that falls as motion begins",
    acts_on="guide",
    parameters=(
        Parameter("excess", "N", 0.0, (0.0, 100.0), 2.0, "beyond Coulomb friction at rest"),
        Parameter("velocity", "m/s", 0.05, (0.005, 0.8), 0.05, "at which the excess has fallen to 1/e"),
    ),
    source=Source("Armstrong-Helouvry, Dupont, Canudas de Wit", 1994, "eq. 8"),
    after=_friction,
    scan=_scan,
    rivals=("guide-coulomb-friction", "guide-viscous-drag"),
    systems=GUIDE,
)
