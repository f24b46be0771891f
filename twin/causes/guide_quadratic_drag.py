"""A drag in the guide that grows with the square of speed: air, a piston of air behind the weight."""

from __future__ import annotations

from twin.causes._kind import GUIDE, Cause, dynamics
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _drag(q, p):  # type: ignore[no-untyped-def]
    q[k.G] += p[1] * q[k.V] * abs(q[k.V])


guide_quadratic_drag = Cause(
    name="guide-quadratic-drag",
    title="quadratic drag in the guide",
    acts_on="guide",
    parameters=(Parameter("coefficient", "N*s^2/m^2", 0.0, (0.0, 1000.0), 6.0, "force per speed squared"),),
    source=Source("assumed"),
    after=_drag,
    rivals=("guide-viscous-drag", "velocity-dependent-damping"),
    systems=GUIDE,
)
