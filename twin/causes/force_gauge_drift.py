"""The force gauge's zero moves at a constant rate from the run's start."""

from __future__ import annotations

from twin.causes._kind import Cause, Undo, Values, sensor
from twin.parameter import Parameter, Source


@sensor
def _add(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    for i in range(int(about[0])):
        force[i] += p[1] * (about[2] + i * about[1])


def _undo(values: Values) -> Undo:
    return Undo(F_rate=values["rate"])


force_gauge_drift = Cause(
    name="force-gauge-drift",
    title="the force gauge drifts",
    acts_on="force-gauge",
    parameters=(Parameter("rate", "N/s", 0.0, (-50.0, 50.0), 0.1, "of the drift"),),
    source=Source("assumed"),
    how="sensor",
    senses=_add,
    order=6,
    undo=_undo,
    rivals=("fibre-creep",),
)
