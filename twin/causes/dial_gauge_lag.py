"""A first-order lag in the dial gauge, exact for a signal straight between samples."""

from __future__ import annotations

from twin.causes._delay import lag_line
from twin.causes._kind import Cause, Undo, Values, sensor
from twin.parameter import Parameter, Source


@sensor
def _lag(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    lag_line(position, int(about[0]), p[1] / about[1])


def _undo(values: Values) -> Undo:
    return Undo(u_lag=values["time_constant"])


dial_gauge_lag = Cause(
    name="dial-gauge-lag",
    title="the dial gauge lags",
    acts_on="dial-gauge",
    parameters=(Parameter("time_constant", "s", 0.0, (0.0, 0.2), 0.003, "of a first-order lag"),),
    source=Source("assumed"),
    how="sensor",
    senses=_lag,
    order=2,
    undo=_undo,
    rivals=("dial-gauge-delay",),
)
