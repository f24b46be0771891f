"""A Kelvin-Voigt element in series with the fibre: time_constant e' = compliance (T - T0) - e."""

from __future__ import annotations

from collections.abc import Sequence

from twin.causes._kind import Cause, Survey, Values, dynamics, grid, strands
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _shorten(q, p):  # type: ignore[no-untyped-def]
    own = k.AUX + int(p[0])
    q[k.D1] -= q[own] / p[3]
    if p[4] > 0.0:
        q[k.D2] -= q[own] / p[4]


@dynamics
def _creep(q, p):  # type: ignore[no-untyped-def]
    own = int(p[0])
    q[k.RATE + own] = (p[1] * (q[k.T2] - q[k.REST]) - q[k.AUX + own]) / p[2]


def _scan(survey: Survey) -> Sequence[Values]:
    return grid({}, compliance=(2e-6, 1.5e-5), time_constant=(0.1, 0.4, 1.5, 6.0))


fibre_creep = Cause(
    name="fibre-creep",
    title="a fibre that creeps",
    acts_on="fibre",
    parameters=(
        Parameter("compliance", "m/N", 0.0, (0.0, 0.0001), 5e-06, "of the Kelvin-Voigt element, whole fibre"),
        Parameter("time_constant", "s", 2.0, (0.05, 100.0), 1.0, "of its creep"),
    ),
    source=Source("assumed"),
    before=_shorten,
    after=_creep,
    states=1,
    pack=strands,
    scan=_scan,
    rivals=("fibre-viscoelasticity", "force-gauge-drift", "fibre-pulley-slip"),
)
