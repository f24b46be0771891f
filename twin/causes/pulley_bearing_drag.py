"""A drag at the rim proportional to its speed: grease in the bearing."""

from __future__ import annotations

from twin.causes._kind import WFPD, Cause, dynamics
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _drag(q, p):  # type: ignore[no-untyped-def]
    q[k.R] += p[1] * q[k.W]


pulley_bearing_drag = Cause(
    name="pulley-bearing-drag",
    title="viscous drag in the pulley's bearing",
    acts_on="pulley",
    parameters=(Parameter("coefficient", "N*s/m", 0.0, (0.0, 500.0), 3.0, "rim force per rim speed"),),
    source=Source("assumed"),
    after=_drag,
    rivals=("guide-viscous-drag", "pulley-bearing-friction"),
    systems=WFPD,
)
