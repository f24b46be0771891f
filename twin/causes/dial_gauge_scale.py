"""The dial gauge tells gain times the truth."""

from __future__ import annotations

from twin.causes._kind import Cause, Undo, Values, sensor
from twin.parameter import Parameter, Source


@sensor
def _gain(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    for i in range(int(about[0])):
        position[i] *= p[1]


def _undo(values: Values) -> Undo:
    return Undo(u_gain=values["gain"])


dial_gauge_scale = Cause(
    name="dial-gauge-scale",
    title="the dial gauge's gain is off",
    acts_on="dial-gauge",
    parameters=(Parameter("gain", "-", 1.0, (0.3, 3.0), 0.02, "recorded over true"),),
    source=Source("assumed"),
    how="sensor",
    senses=_gain,
    order=5,
    undo=_undo,
    rivals=(
        "pulley-eccentricity",
        "drive-scale",
    ),
)
