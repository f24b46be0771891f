"""An eccentric pulley: the weight strand is longer by amplitude (sin(s/r + phase) - sin(phase))."""

from __future__ import annotations

import math
from collections.abc import Sequence

from twin.causes._kind import WFPD, Cause, Survey, Values, dynamics, grid
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _strand(q, p):  # type: ignore[no-untyped-def]
    angle = q[k.S] / q[k.RADIUS] + p[2]
    lever = p[1] / q[k.RADIUS] * math.cos(angle)
    q[k.D1] += p[1] * (math.sin(angle) - math.sin(p[2]))
    q[k.DD1] += lever * q[k.W]
    q[k.GAMMA1] += lever


def _scan(survey: Survey) -> Sequence[Values]:
    return grid({"amplitude": 2e-4}, phase=[i * math.pi / 4 - math.pi for i in range(8)])


pulley_eccentricity = Cause(
    name="pulley-eccentricity",
    title="a pulley out of centre",
    acts_on="pulley",
    parameters=(
        Parameter("amplitude", "m", 0.0, (0.0, 0.01), 0.0003, "of the strand's extra length"),
        Parameter("phase", "rad", 0.0, (-6.4, 6.4), 0.5, "at rest"),
    ),
    source=Source("assumed"),
    before=_strand,
    scan=_scan,
    rivals=("dial-gauge-scale", "drive-scale"),
    systems=WFPD,
)
