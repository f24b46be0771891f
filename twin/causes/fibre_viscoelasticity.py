"""A Maxwell branch beside each strand: k z with z' = d' - z/time_constant."""

from __future__ import annotations

from collections.abc import Sequence

from twin.causes._kind import Cause, Survey, Values, dynamics, grid, strands
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _branch(q, p):  # type: ignore[no-untyped-def]
    own = k.AUX + int(p[0])
    rate = k.RATE + int(p[0])
    q[k.E1] += p[1] * p[3] * q[own]
    q[k.E2] += p[1] * p[4] * q[own + 1]
    q[rate] = (q[k.DD1] if q[k.D1] > 0.0 else 0.0) - q[own] / p[2]
    q[rate + 1] = (q[k.DD2] if q[k.D2] > 0.0 else 0.0) - q[own + 1] / p[2]
    q[k.STIFF] = max(q[k.STIFF], 1.0 / p[2])


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
    pack=strands,
    scan=_scan,
    rivals=("fibre-damping", "fibre-hysteresis", "fibre-creep"),
)
