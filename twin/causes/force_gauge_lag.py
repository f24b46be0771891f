"""A first-order lag in the force gauge, exact for a signal straight between samples."""

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
    slope = 0.25 * (force[4] - force[0])
    old = force[0]
    held = old - tau * slope
    force[0] = held
    for i in range(1, int(about[0])):
        new = force[i]
        held = held * decay + old * (gone - decay) + new * (1.0 - gone)
        old = new
        force[i] = held


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
