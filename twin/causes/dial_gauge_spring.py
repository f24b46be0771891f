"""The dial gauge's plunger spring: a force -stiffness u on the weight, beyond its share at rest."""

from __future__ import annotations

from twin.causes._kind import Cause, dynamics
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _spring(q, p):  # type: ignore[no-untyped-def]
    q[k.G] += p[1] * q[k.U]


dial_gauge_spring = Cause(
    name="dial-gauge-spring",
    title="the gauge's plunger spring loads the weight",
    acts_on="weight",
    parameters=(Parameter("stiffness", "N/m", 0.0, (0.0, 2000.0), 20.0, "of the spring"),),
    source=Source("assumed"),
    after=_spring,
    rivals=("force-gauge-scale", "incline-angle"),
)
