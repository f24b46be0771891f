"""A first-order lag in the force gauge, exact for a signal straight between samples."""

from __future__ import annotations

from twin.causes._delay import lag_line
from twin.causes._kind import Cause, Undo, Values, sensor
from twin.parameter import Parameter, Source


@sensor
def _lag(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    lag_line(force, int(about[0]), p[1] / about[1])


def _undo(values: Values) -> Undo:
    return Undo(F_lag=values["time_constant"])


force_gauge_lag = Cause(
    name="force-gauge-lag",
    title="the force gauge lags",
    acts_on="force-gauge",
    parameters=(Parameter("time_constant", "s", 0.0, (0.0, 0.2), 0.003, "of a first-order lag"),),
    source=Source("assumed"),
    how="sensor",
    senses=_lag,
    order=2,
    undo=_undo,
    rivals=("force-gauge-delay",),
)
