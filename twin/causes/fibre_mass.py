"""The fibre's own inertia: each strand stretches evenly between its ends, the arc goes with the rim.

A straight strand of mass m whose ends move at v1 and v2 has the kinetic energy m (v1^2 + v1 v2 + v2^2) / 6, the
consistent mass matrix of a bar (Archer 1963, J. Struct. Div. ASCE 89, 161): what a standing end carries is a third of
the strand, not half of it.
"""

from __future__ import annotations

from collections.abc import Sequence

from stand.setup import Setup
from twin.causes._kind import WFPD, Cause, Values, dynamics, sensor
from twin.kernels import composed_slots as k
from twin.parameter import Parameter, Source


@dynamics
def _inertia(q, p):  # type: ignore[no-untyped-def]
    line = p[1] / p[2]
    weight, drive = line * p[3], line * p[4]
    q[k.MASS] += weight / 3.0
    q[k.SHARED] += weight / 6.0
    q[k.RIM] += p[1] - (weight + drive) * 2.0 / 3.0
    q[k.PULL] -= drive / 6.0 * q[k.XDD]


@sensor
def _gauge(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    drive, n = p[1] / p[2] * p[4], int(about[0])
    over = 1.0 / (about[1] * about[1])
    for i in range(n):
        m = min(max(i, 1), n - 2)  # the rim's acceleration, from its displacement
        rim = (simulated[5 * m - 1] - 2.0 * simulated[5 * m + 4] + simulated[5 * m + 9]) * over
        force[i] += drive * (simulated[5 * i + 3] / 3.0 + rim / 6.0)


def _pack(setup: Setup, values: Values, own: int) -> Sequence[float]:
    return (float(own), values["mass"], setup.fibre_length, setup.weight_strand_length, setup.drive_strand_length)


fibre_mass = Cause(
    name="fibre-mass",
    title="the fibre's own mass matters",
    acts_on="fibre",
    parameters=(Parameter("mass", "kg", 0.0, (0.0, 2.0), 0.03, "whole fibre's"),),
    source=Source("Archer", 1963, "consistent mass matrix of a bar"),
    after=_inertia,
    senses=_gauge,
    pack=_pack,
    rivals=("pulley-inertia", "force-gauge-inertia"),
    systems=WFPD,
)
