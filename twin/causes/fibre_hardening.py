"""A fibre whose tension is c d (1 + coefficient d); d of the whole fibre, a strand's share goes with its length."""

from __future__ import annotations

import math

from numba import njit

from twin.causes._kind import Cause, dynamics, strands
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@njit("float64(float64,float64)", cache=True)
def _stretch(linear, coefficient):  # type: ignore[no-untyped-def]
    """How much further (or less) the hardening strand is stretched at rest than the linear one, m."""
    if abs(coefficient * linear) < 1e-12:
        return 0.0
    root = 1.0 + 4.0 * coefficient * linear
    return (math.sqrt(max(root, 0.0)) - 1.0) / (2.0 * coefficient) - linear


@dynamics
def _hardening(q, p):  # type: ignore[no-untyped-def]
    k1 = p[1] * p[2]
    k2 = p[1] * p[3]
    q[k.D1] += _stretch(q[k.REST] / q[k.C1], k1)
    q[k.D2] += _stretch(q[k.REST] / q[k.C2], k2)
    if q[k.D1] > 0.0:
        q[k.E1] += q[k.C1] * k1 * q[k.D1] * q[k.D1]
    if q[k.D2] > 0.0:
        q[k.E2] += q[k.C2] * k2 * q[k.D2] * q[k.D2]


fibre_hardening = Cause(
    name="fibre-hardening",
    title="a fibre that stiffens as it stretches",
    acts_on="fibre",
    parameters=(Parameter("coefficient", "1/m", 0.0, (-200.0, 5000.0), 50.0, "T = c d (1 + coefficient d)"),),
    source=Source("assumed"),
    before=_hardening,
    pack=strands,
    rivals=("fibre-stiffness", "velocity-dependent-stiffness"),
)
