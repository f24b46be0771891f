"""A Bouc-Wen branch beside each strand: k z, z' = d' - (|d'| z + d' |z|)/(2 yield)."""

from __future__ import annotations

import math
from collections.abc import Sequence

from twin.causes._kind import Cause, Survey, Values, dynamics, grid, strands
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _branch(q, p):  # type: ignore[no-untyped-def]
    own = k.AUX + int(p[0])
    rate = k.RATE + int(p[0])
    q[k.E1] += p[1] * p[3] * q[own]
    q[k.E2] += p[1] * p[4] * q[own + 1]
    y1 = p[2] / p[3]
    y2 = p[2] / max(p[4], 1.0)
    r1 = q[k.DD1] if q[k.D1] > 0.0 else 0.0
    r2 = q[k.DD2] if q[k.D2] > 0.0 else 0.0
    q[rate] = r1 - 0.5 * (abs(r1) * q[own] + r1 * abs(q[own])) / y1
    q[rate + 1] = r2 - 0.5 * (abs(r2) * q[own + 1] + r2 * abs(q[own + 1])) / y2
    stiff = q[k.C1] + q[k.C2] + p[1] * (p[3] + p[4])
    rim = 0.6 * math.sqrt(stiff / q[k.RIM]) if q[k.RIM] > 0.0 else 0.0  # as `composed_force.pace`, the branch with it
    q[k.STIFF] = max(q[k.STIFF], rim, 0.5 * (abs(r1) / y1 + abs(r2) / y2))


def _scan(survey: Survey) -> Sequence[Values]:
    return grid({"stiffness": 5e3}, yield_elongation=(5e-5, 1.5e-4, 5e-4))


fibre_hysteresis = Cause(
    name="fibre-hysteresis",
    title="a fibre with rate-independent hysteresis",
    acts_on="fibre",
    parameters=(
        Parameter("stiffness", "N/m", 0.0, (0.0, 300000.0), 5000.0, "of the Bouc-Wen branch, whole fibre"),
        Parameter("yield_elongation", "m", 0.0002, (1e-05, 0.005), 0.0002, "whole fibre's"),
    ),
    source=Source("Wen", 1976, "eq. 4 with n = 1"),
    before=_branch,
    states=2,
    pack=strands,
    scan=_scan,
    rivals=("fibre-damping", "fibre-viscoelasticity", "pulley-bearing-friction"),
)
