"""A Maxwell branch beside each strand: k (d - e), e' = (d - e) / time_constant, d the strand's elongation where taut.

States are the dashpots' elongations e beyond those at rest: unlike the springs' they need no rates of d, which a
snatch changes within a sample.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from twin.causes._kind import Cause, Survey, Values, dynamics, grid, strands
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _branch(q, p):  # type: ignore[no-untyped-def]
    own = int(p[0])
    spring1 = max(q[k.D1], 0.0) - q[k.ZERO1] - q[k.AUX + own]
    spring2 = max(q[k.D2], 0.0) - q[k.ZERO2] - q[k.AUX + own + 1]
    q[k.E1] += p[1] * p[3] * spring1
    q[k.E2] += p[1] * p[4] * spring2
    q[k.RATE + own] = spring1 / p[2]
    q[k.RATE + own + 1] = spring2 / p[2]
    stiff = q[k.C1] + q[k.C2] + p[1] * (p[3] + p[4])
    rim = 0.6 * math.sqrt(stiff / q[k.RIM]) if q[k.RIM] > 0.0 else 0.0  # as `composed_force.pace`, the branch with it
    q[k.STIFF] = max(q[k.STIFF], rim, 1.0 / p[2])


def _scan(survey: Survey) -> Sequence[Values]:
    return grid({"stiffness": 4e3}, time_constant=(0.003, 0.01, 0.03, 0.1, 0.4, 1.5))


fibre_viscoelasticity = Cause(
    name="fibre-viscoelasticity",
    title="a fibre that relaxes",
    acts_on="fibre",
    parameters=(
        Parameter("stiffness", "N/m", 0.0, (0.0, 300000.0), 5000.0, "of the Maxwell branch, whole fibre"),
        Parameter("time_constant", "s", 0.05, (0.0005, 20.0), 0.02, "of its relaxation"),
    ),
    source=Source("assumed"),
    before=_branch,
    states=2,
    order=-1,
    pack=strands,
    scan=_scan,
    rivals=("fibre-damping", "fibre-hysteresis", "fibre-creep"),
)
