"""A drag in the guide proportional to speed: grease, a dashpot, eddy currents."""

from __future__ import annotations

from twin.causes._kind import GUIDE, Cause, dynamics
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _drag(q, p):  # type: ignore[no-untyped-def]
    q[k.G] += p[1] * q[k.V]


guide_viscous_drag = Cause(
    name="guide-viscous-drag",
    title="viscous drag in the guide",
    acts_on="guide",
    parameters=(Parameter("coefficient", "N*s/m", 0.0, (0.0, 1000.0), 4.0, "force per speed"),),
    source=Source("assumed"),
    after=_drag,
    rivals=("guide-quadratic-drag", "guide-stribeck-friction", "velocity-dependent-damping"),
    systems=GUIDE,
)
