"""A first-order lag in the dial gauge, exact for a signal straight between samples."""

from __future__ import annotations

import math

from twin.causes._kind import Cause, Undo, Values, sensor
from twin.parameter import Parameter, Source


@sensor
def _lag(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    tau = p[1] / about[1]
    if tau < 1e-6:
        return
    decay = math.exp(-1.0 / tau)
    gone = tau * (1.0 - decay)
    slope = 0.25 * (position[4] - position[0])
    old = position[0]
    held = old - tau * slope
    position[0] = held
    for i in range(1, int(about[0])):
        new = position[i]
        held = held * decay + old * (gone - decay) + new * (1.0 - gone)
        old = new
        position[i] = held


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
