"""Fibre stiffness c + slope (|u'| - threshold) above a speed of the weight."""

from __future__ import annotations

from collections.abc import Sequence

from twin.causes._kind import Cause, Survey, Values, dynamics, grid, strands
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _stiffness(q, p):  # type: ignore[no-untyped-def]
    beyond = abs(q[k.V]) - p[2]
    if beyond > 0.0:
        q[k.C1] += p[1] * beyond * p[3]
        q[k.C2] += p[1] * beyond * p[4]


def _scan(survey: Survey) -> Sequence[Values]:
    return grid({"slope": 5e3}, threshold=[f * survey.speed for f in (0.02, 0.2, 0.35, 0.5, 0.65, 0.8)])


velocity_dependent_stiffness = Cause(
    name="velocity-dependent-stiffness",
    title="fibre stiffness that grows with speed",
    acts_on="fibre",
    parameters=(
        Parameter("slope", "N*s/m^2", 0.0, (-30000.0, 1000000.0), 8000.0, "of the whole fibre's stiffness over speed"),
        Parameter("threshold", "m/s", 0.4, (0.0, 3.0), 0.1, "speed of the weight above which it grows"),
    ),
    source=Source("Polach, Hajzman, Dupal", 2020, "section 4"),
    before=_stiffness,
    pack=strands,
    scan=_scan,
    rivals=("fibre-hardening", "velocity-dependent-damping"),
)
