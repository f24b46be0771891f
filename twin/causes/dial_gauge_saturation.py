"""The dial gauge cannot tell more than a level."""

from __future__ import annotations

from collections.abc import Sequence

from twin.causes._kind import Cause, Survey, Values, sensor
from twin.parameter import Parameter, Source


@sensor
def _clip(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    for i in range(int(about[0])):
        position[i] = min(position[i], p[1])


def _scan(survey: Survey) -> Sequence[Values]:
    low, high = survey.u
    return [{"level": high - d} for d in (0.0, 3.5 * survey.noise_u, 0.003 * (high - low), 0.02 * (high - low))]


dial_gauge_saturation = Cause(
    name="dial-gauge-saturation",
    title="the dial gauge saturates",
    acts_on="dial-gauge",
    parameters=(Parameter("level", "m", 1000.0, (0.0, 1000.0), 0.01, "that it cannot pass"),),
    source=Source("assumed"),
    how="sensor",
    senses=_clip,
    order=7,
    scan=_scan,
    rivals=("end-stop",),
)
