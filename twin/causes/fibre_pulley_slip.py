"""A fibre that slides on the rim where one tension is exp(friction * wrap) of the other (Euler, Eytelwein)."""

from __future__ import annotations

import math
from collections.abc import Sequence

from stand.setup import Setup
from twin.causes._kind import WFPD, Cause, Survey, Values, dynamics, grid
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _slide(q, p):  # type: ignore[no-untyped-def]
    own = int(p[0])
    hold = p[2]
    q[k.D1] += q[k.AUX + own]
    q[k.D2] -= q[k.AUX + own]
    t1 = q[k.C1] * q[k.D1] + q[k.B1] * q[k.DD1] + q[k.E1]
    t2 = q[k.C2] * q[k.D2] + q[k.B2] * q[k.DD2] + q[k.E2]
    pull1 = t1 if q[k.D1] > 0.0 and t1 > 0.0 else 0.0
    pull2 = t2 if q[k.D2] > 0.0 and t2 > 0.0 else 0.0
    slide = 0.0  # what brings the tensions back to the ratio; no strand is let down further than to nothing
    if pull2 > hold * pull1:
        slide = pull2 / q[k.B2]
        if q[k.D1] > 0.0:
            slide = min(slide, (t2 - hold * t1) / (q[k.B2] + hold * q[k.B1]))
    elif pull1 > hold * pull2:
        slide = -pull1 / q[k.B1]
        if q[k.D2] > 0.0:
            slide = max(slide, (hold * t2 - t1) / (q[k.B1] + hold * q[k.B2]))
    q[k.DD1] += slide
    q[k.DD2] -= slide
    q[k.RATE + own] = slide
    if slide != 0.0:
        q[k.STIFF] = max(q[k.STIFF], q[k.C2] / q[k.B2])


def _pack(setup: Setup, values: Values, own: int) -> Sequence[float]:
    return (float(own), values["friction"], math.exp(min(values["friction"] * setup.wrap_angle, 50.0)))


def _scan(survey: Survey) -> Sequence[Values]:
    return grid({}, friction=(0.02, 0.05, 0.1, 0.15, 0.22, 0.32, 0.45, 0.65))


fibre_pulley_slip = Cause(
    name="fibre-pulley-slip",
    title="the fibre slides on the pulley",
    acts_on="pulley",
    parameters=(Parameter("friction", "-", 5.0, (0.01, 5.0), 0.05, "at which it slides"),),
    source=Source("Euler", 1769, "capstan equation"),
    before=_slide,
    states=1,
    slides=True,
    order=9,
    pack=_pack,
    scan=_scan,
    rivals=("pulley-bearing-friction", "fibre-creep"),
    systems=WFPD,
)
