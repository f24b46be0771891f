"""The fibre's drive end at x - compliance (F - T0); in series with its strand, to first order in the damping."""

from __future__ import annotations

from twin.causes._kind import WFPD, Cause, dynamics
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _softer(q, p):  # type: ignore[no-untyped-def]
    share = 1.0 / (1.0 + p[1] * q[k.C2])
    q[k.D2] += (1.0 - share) * 0.0
    rest = q[k.REST] / q[k.C2]
    q[k.D2] += rest * (1.0 / share - 1.0)
    q[k.C2] *= share
    q[k.B2] *= share * share


drive_compliance = Cause(
    name="drive-compliance",
    title="the drive gives way under load",
    acts_on="drive",
    parameters=(Parameter("compliance", "m/N", 0.0, (0.0, 0.0001), 1e-06, "of drive and mount"),),
    source=Source("assumed"),
    before=_softer,
    order=5,
    rivals=("fibre-stiffness",),
    systems=WFPD,
)
