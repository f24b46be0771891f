"""Play between encoder and fibre: the fibre's end follows the drive with a gap."""

from __future__ import annotations

from collections.abc import Sequence

from twin.causes._kind import WFPD, Cause, Survey, Values, drive_input, grid
from twin.parameter import Parameter, Source


@drive_input
def _play(x, speed, about, p):  # type: ignore[no-untyped-def]
    half = 0.5 * p[1]
    shift = half * p[2]
    end = 0.0
    for i in range(int(about[0])):
        low = x[i] - half - shift
        high = x[i] + half - shift
        if end < low:
            end = low
        elif end > high:
            end = high
        else:
            speed[i] = 0.0
        x[i] = end


def _scan(survey: Survey) -> Sequence[Values]:
    return grid({}, width=(1e-4, 3e-4, 1e-3), start=(-0.9, 0.0, 0.9))


drive_backlash = Cause(
    name="drive-backlash",
    title="play between the drive and the fibre",
    acts_on="drive",
    parameters=(
        Parameter("width", "m", 0.0, (0.0, 0.02), 0.0005, "the whole gap"),
        Parameter("start", "-", 0.0, (-1.0, 1.0), 0.5, "place in the gap at rest, -1 to 1"),
    ),
    source=Source("assumed"),
    how="input",
    moves=_play,
    scan=_scan,
    rest_free=True,
    rivals=("drive-delay", "dial-gauge-sticking"),
    systems=WFPD,
)
