"""The fibre's drive end at x - compliance (F - T0), in series with its strand (c2, b2).

F / (x - s) = (c2 + b2 p) / (a (1 + tau p)) = c2 / a + b2 / a^2 p / (1 + tau p), a = 1 + compliance c2 and
tau = compliance b2 / a, p = d/dt: the damper sees the elongation's rate behind a first-order lag of its own.
"""

from __future__ import annotations

from collections.abc import Sequence

from twin.causes._kind import WFPD, Cause, Survey, Values, dynamics, grid
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source

#: s: quicker lags act through this one in proportion, right to first order, and the step need not follow them
QUICKEST = 2.5e-4


@dynamics
def _softer(q, p):  # type: ignore[no-untyped-def]
    own = int(p[0])
    share = 1.0 / (1.0 + p[1] * q[k.C2])
    lag = p[1] * q[k.B2] * share
    slow = max(lag, QUICKEST)
    q[k.D2] += q[k.REST] / q[k.C2] * (1.0 / share - 1.0)
    q[k.C2] *= share
    q[k.B2] *= share * share
    rate = q[k.DD2] if q[k.D2] > 0.0 else 0.0
    q[k.E2] += q[k.B2] * lag / slow * (q[k.AUX + own] - rate)
    q[k.RATE + own] = (rate - q[k.AUX + own]) / slow
    q[k.STIFF] = max(q[k.STIFF], 1.0 / slow)


def _scan(survey: Survey) -> Sequence[Values]:
    return grid({}, compliance=(1e-7, 1e-6, 4e-6))


drive_compliance = Cause(
    name="drive-compliance",
    title="the drive gives way under load",
    acts_on="drive",
    parameters=(Parameter("compliance", "m/N", 0.0, (0.0, 0.0001), 1e-06, "of drive and mount"),),
    source=Source("assumed"),
    before=_softer,
    states=1,
    order=5,
    scan=_scan,
    rivals=("fibre-stiffness",),
    systems=WFPD,
)
