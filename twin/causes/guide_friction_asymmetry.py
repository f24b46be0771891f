"""Dry friction that is F_c + difference/2 going up and F_c - difference/2 going down."""

from __future__ import annotations

from twin.causes._kind import GUIDE, Cause, dynamics
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _friction(q, p):  # type: ignore[no-untyped-def]
    q[k.FRICTION] += 0.5 * p[1] * q[k.SMOOTH]


guide_friction_asymmetry = Cause(
    name="guide-friction-asymmetry",
    title="dry friction up unlike down",
    acts_on="guide",
    parameters=(Parameter("difference", "N", 0.0, (-60.0, 60.0), 1.5, "up minus down"),),
    source=Source("assumed"),
    after=_friction,
    rivals=("incline-angle", "weight-mass", "force-gauge-offset"),
    systems=GUIDE,
)
