"""The force gauge tells what was `delay` seconds before."""

from __future__ import annotations

from twin.causes._delay import delay_line
from twin.causes._kind import GUIDE, Cause, Undo, Values, drive_input, sensor
from twin.parameter import Parameter, Source


@sensor
def _late(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    delay_line(force, int(about[0]), p[1] / about[1], 0.0)


@drive_input
def _sooner(x, speed, about, p):  # type: ignore[no-untyped-def]
    delay_line(x, int(about[0]), -p[1] / about[1], 0.0)
    delay_line(speed, int(about[0]), -p[1] / about[1], 0.0)


def _undo(values: Values) -> Undo:
    return Undo(F_late=values["delay"])


force_gauge_delay = Cause(
    name="force-gauge-delay",
    title="the force gauge is late",
    acts_on="force-gauge",
    parameters=(Parameter("delay", "s", 0.0, (-0.02, 0.1), 0.002, "of the signal"),),
    source=Source("assumed"),
    how="sensor",
    senses=_late,
    order=4,
    undo=_undo,
    moves=_sooner,
    systems=GUIDE,
    rivals=("force-gauge-lag", "drive-delay", "clock-drift"),
)
