"""The fibre's drive end is where the drive was recorded to be `delay` seconds before."""

from __future__ import annotations

import math

from twin.causes._kind import WFPD, Cause, drive_input
from twin.parameter import Parameter, Source


@drive_input
def _late(x, speed, about, p):  # type: ignore[no-untyped-def]
    n = int(about[0])
    dt = about[1]
    shift = p[1] / dt
    step = 1 if shift < 0.0 else -1
    at = 0 if shift < 0.0 else n - 1
    for _ in range(n):
        place = at - shift
        i = min(max(int(math.floor(place)), 0), n - 2)
        t = min(max(place - i, 0.0), 1.0)
        a, b = speed[i] * dt, speed[i + 1] * dt
        rise = x[i + 1] - x[i]
        c2, c3 = 3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise
        x[at] = x[i] + t * (a + t * (c2 + t * c3))
        speed[at] = (a + t * (2.0 * c2 + 3.0 * t * c3)) / dt
        at += step


drive_delay = Cause(
    name="drive-delay",
    title="the drive is where it was recorded to be, later",
    acts_on="drive",
    parameters=(Parameter("delay", "s", 0.0, (-0.05, 0.1), 0.002, "of the motion against the record"),),
    source=Source("assumed"),
    how="input",
    moves=_late,
    rivals=("dial-gauge-delay", "force-gauge-delay", "clock-drift"),
    systems=WFPD,
)
