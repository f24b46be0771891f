"""A dial gauge that follows with a dead band (play)."""

from __future__ import annotations

from twin.causes._kind import Cause, Undo, Values, sensor
from twin.parameter import Parameter, Source


@sensor
def _stick(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    half = 0.5 * p[1]
    speed = simulated[1]
    told = position[0] - half * min(max(speed / 0.002, -1.0), 1.0)
    for i in range(int(about[0])):
        told = min(max(told, position[i] - half), position[i] + half)
        position[i] = told


def _undo(values: Values) -> Undo:
    return Undo(u_side=0.5 * values["width"])


dial_gauge_sticking = Cause(
    name="dial-gauge-sticking",
    title="the dial gauge sticks",
    acts_on="dial-gauge",
    parameters=(Parameter("width", "m", 0.0, (0.0, 0.02), 0.0002, "the whole dead band"),),
    source=Source("assumed"),
    how="sensor",
    senses=_stick,
    order=6,
    undo=_undo,
    rivals=("drive-backlash", "dial-gauge-lag"),
)
