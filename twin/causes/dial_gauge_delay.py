"""The dial gauge tells what was `delay` seconds before."""

from __future__ import annotations

from twin.causes._delay import delay_line
from twin.causes._kind import Cause, Undo, Values, sensor
from twin.parameter import Parameter, Source


@sensor
def _late(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    delay_line(position, int(about[0]), p[1] / about[1], 0.0)


def _undo(values: Values) -> Undo:
    return Undo(u_late=values["delay"])


dial_gauge_delay = Cause(
    name="dial-gauge-delay",
    title="the dial gauge is late",
    acts_on="dial-gauge",
    parameters=(Parameter("delay", "s", 0.0, (-0.02, 0.1), 0.002, "of the signal"),),
    source=Source("assumed"),
    how="sensor",
    senses=_late,
    order=4,
    undo=_undo,
    rivals=("dial-gauge-lag", "drive-delay", "clock-drift"),
)
