"""A mass that moves with the drive on the fibre's side of the gauge: F + mass x''."""

from __future__ import annotations

from twin.causes._kind import WFPD, Cause, Undo, Values, sensor
from twin.parameter import Parameter, Source


@sensor
def _add(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    for i in range(int(about[0])):
        force[i] += p[1] * simulated[5 * i + 3]


def _undo(values: Values) -> Undo:
    return Undo(F_mass=values["mass"])


force_gauge_inertia = Cause(
    name="force-gauge-inertia",
    title="mass between the force gauge and the fibre",
    acts_on="force-gauge",
    parameters=(Parameter("mass", "kg", 0.0, (0.0, 20.0), 0.1, "that moves with the drive"),),
    source=Source("assumed"),
    how="sensor",
    senses=_add,
    order=0,
    undo=_undo,
    rivals=("pulley-inertia", "fibre-mass"),
    systems=WFPD,
)
