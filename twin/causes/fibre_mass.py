"""The fibre's own inertia: half of each strand goes with its ends, the arc with the rim."""

from __future__ import annotations

from collections.abc import Sequence

from stand.setup import Setup
from twin.causes._kind import WFPD, Cause, Values, dynamics, sensor
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _inertia(q, p):  # type: ignore[no-untyped-def]
    line = p[1] / p[2]
    q[k.MASS] += 0.5 * line * p[3]
    q[k.RIM] += line * (p[2] - 0.5 * (p[3] + p[4]))


@sensor
def _gauge(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    share = 0.5 * p[1] / p[2] * p[4]
    for i in range(int(about[0])):
        force[i] += share * simulated[5 * i + 3]


def _pack(setup: Setup, values: Values, own: int) -> Sequence[float]:
    return (float(own), values["mass"], setup.fibre_length, setup.weight_strand_length, setup.drive_strand_length)


fibre_mass = Cause(
    name="fibre-mass",
    title="the fibre's own mass matters",
    acts_on="fibre",
    parameters=(Parameter("mass", "kg", 0.0, (0.0, 2.0), 0.03, "whole fibre's"),),
    source=Source("assumed"),
    after=_inertia,
    senses=_gauge,
    pack=_pack,
    rivals=("pulley-inertia", "force-gauge-inertia"),
    systems=WFPD,
)
