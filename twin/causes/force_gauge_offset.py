"""The force gauge tells `offset` at no force."""

from __future__ import annotations

from twin.causes._kind import GUIDE, Cause, Undo, Values, drive_input, sensor
from twin.parameter import Parameter, Source


@sensor
def _add(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    for i in range(int(about[0])):
        force[i] += p[1]


@drive_input
def _take(x, speed, about, p):  # type: ignore[no-untyped-def]
    for i in range(int(about[0])):
        x[i] -= p[1]


def _undo(values: Values) -> Undo:
    return Undo(F_offset=values["offset"])


force_gauge_offset = Cause(
    name="force-gauge-offset",
    title="the force gauge's zero is off",
    acts_on="force-gauge",
    parameters=(Parameter("offset", "N", 0.0, (-200.0, 200.0), 1.0, "told at no force"),),
    source=Source("assumed"),
    how="sensor",
    senses=_add,
    order=6,
    undo=_undo,
    moves=_take,
    systems=GUIDE,
    rivals=("weight-mass", "incline-angle", "guide-friction-asymmetry"),
)
