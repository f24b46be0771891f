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
    return [{"level": high - d} for d in (0.0, 3.5 * survey.noise_F, 0.003 * (high - low), 0.02 * (high - low))]


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
