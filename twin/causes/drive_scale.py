"""The fibre's drive end moves gain times what was recorded."""

from __future__ import annotations

from twin.causes._kind import WFPD, Cause, drive_input
from twin.parameter import Parameter, Source


@drive_input
def _gain(x, speed, about, p):  # type: ignore[no-untyped-def]
    for i in range(int(about[0])):
        x[i] *= p[1]
        speed[i] *= p[1]


drive_scale = Cause(
    name="drive-scale",
    title="the drive's position gain is off",
    acts_on="drive",
    parameters=(Parameter("gain", "-", 1.0, (0.5, 2.0), 0.02, "true over recorded"),),
    source=Source("assumed"),
    how="input",
    moves=_gain,
    rivals=("dial-gauge-scale", "pulley-eccentricity"),
    systems=WFPD,
)
