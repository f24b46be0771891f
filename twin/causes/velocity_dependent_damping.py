"""Fibre damping b + slope (|u'| - threshold) above a speed of the weight."""

from __future__ import annotations

from collections.abc import Sequence

from twin.causes._kind import Cause, Survey, Values, dynamics, grid, strands
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _damping(q, p):  # type: ignore[no-untyped-def]
    beyond = abs(q[k.V]) - p[2]
    if beyond > 0.0:
        q[k.B1] += p[1] * beyond * p[3]
        q[k.B2] += p[1] * beyond * p[4]


def _scan(survey: Survey) -> Sequence[Values]:
    return grid({"slope": 100.0}, threshold=[f * survey.speed for f in (0.02, 0.2, 0.35, 0.5, 0.65, 0.8)])


velocity_dependent_damping = Cause(
    name="velocity-dependent-damping",
    title="fibre damping that grows with speed",
    acts_on="fibre",
    parameters=(
        Parameter("slope", "N*s^2/m^2", 0.0, (-100.0, 5000.0), 150.0, "of the whole fibre's damping over speed"),
        Parameter("threshold", "m/s", 0.4, (0.0, 3.0), 0.1, "speed of the weight above which it grows"),
    ),
    source=Source("Polach, Hajzman, Dupal", 2020, "eq. 1"),
    before=_damping,
    pack=strands,
    scan=_scan,
    rivals=("fibre-damping", "guide-quadratic-drag"),
)
