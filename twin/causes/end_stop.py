"""A stop in the guide: contact of 1e5 N/m and 300 N s/m beyond its position, above where that is positive, else
below.
"""

from __future__ import annotations

from collections.abc import Sequence

from twin.causes._kind import GUIDE, Cause, Survey, Values, dynamics
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source

STIFFNESS, DAMPING = 1e5, 300.0


@dynamics
def _contact(q, p):  # type: ignore[no-untyped-def]
    side = 1.0 if p[1] > 0.0 else -1.0
    depth = side * (q[k.U] - p[1])
    if depth > 0.0:
        q[k.G] += side * max(0.0, STIFFNESS * depth + DAMPING * side * q[k.V])


def _scan(survey: Survey) -> Sequence[Values]:
    low, high = survey.u
    span = high - low
    inside = (0.0001, 0.0004, 0.001, 0.0025)
    above = [{"position": high - d} for d in inside if high - d > 0.1 * span]
    return above + [{"position": low + d} for d in inside if low + d < -0.1 * span]


end_stop = Cause(
    name="end-stop",
    title="the weight meets a stop",
    acts_on="guide",
    parameters=(Parameter("position", "m", 1.0, (-1.0, 1.0), 0.01, "where the weight meets it"),),
    source=Source("assumed"),
    after=_contact,
    scan=_scan,
    rivals=("dial-gauge-saturation", "guide-rough-patch"),
    systems=GUIDE,
)
