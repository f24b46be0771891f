"""Friction of coefficient (T1 + T2) at the rim, with Dahl's 5 um before it slides, so that it holds at rest."""

from __future__ import annotations

import math

from twin.causes._kind import WFPD, Cause, dynamics
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source

BREAKAWAY = 5e-6
FASTEST = 2500.0


@dynamics
def _friction(q, p):  # type: ignore[no-untyped-def]
    own = int(p[0])
    load = q[k.T1] + q[k.T2]
    q[k.R] += p[1] * load * q[k.AUX + own]
    towards = 1.0 if q[k.W] > 0.0 else -1.0
    rate = min(abs(q[k.W]) / BREAKAWAY, FASTEST)
    q[k.RATE + own] = (towards - q[k.AUX + own]) * rate
    q[k.STIFF] = max(q[k.STIFF], rate, math.sqrt(p[1] * load / (BREAKAWAY * q[k.RIM])))


pulley_bearing_friction = Cause(
    name="pulley-bearing-friction",
    title="friction in the pulley's bearing",
    acts_on="pulley",
    parameters=(Parameter("coefficient", "-", 0.0, (0.0, 0.8), 0.02, "rim force over T1 + T2"),),
    source=Source("Dahl", 1968, "with exponent 1"),
    after=_friction,
    states=1,
    rivals=("guide-coulomb-friction", "fibre-pulley-slip", "pulley-bearing-drag"),
    systems=WFPD,
)
