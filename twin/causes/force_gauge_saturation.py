"""The force gauge cannot tell more than a level."""

from __future__ import annotations

from collections.abc import Sequence

from twin.causes._kind import Cause, Survey, Values, sensor
from twin.parameter import Parameter, Source


@sensor
def _clip(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    for i in range(int(about[0])):
        force[i] = min(force[i], p[1])


def _scan(survey: Survey) -> Sequence[Values]:
    low, high = survey.F
    return [{"level": high - f * (high - low)} for f in (0.0005, 0.002, 0.01)]


force_gauge_saturation = Cause(
    name="force-gauge-saturation",
    title="the force gauge saturates",
    acts_on="force-gauge",
    parameters=(Parameter("level", "N", 1000000000.0, (0.0, 1000000000.0), 50.0, "that it cannot pass"),),
    source=Source("assumed"),
    how="sensor",
    senses=_clip,
    order=7,
    scan=_scan,
)
