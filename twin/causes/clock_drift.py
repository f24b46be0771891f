"""An instrument's clock that runs fast: it tells at t what was at t/(1 + rate)."""

from __future__ import annotations

from dataclasses import replace

from twin.causes._delay import delay_line
from twin.causes._kind import Cause, drive_input, sensor
from twin.parameter import Parameter, Source


@sensor
def _dial(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    rate = p[1] / (1.0 + p[1])
    delay_line(position, int(about[0]), rate * about[2] / about[1], rate)


@sensor
def _force(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    rate = p[1] / (1.0 + p[1])
    delay_line(force, int(about[0]), rate * about[2] / about[1], rate)


@drive_input
def _drive(x, speed, about, p):  # type: ignore[no-untyped-def]
    n = int(about[0])
    delay_line(x, n, 0.0, -p[1])
    delay_line(speed, n, 0.0, -p[1])


_ALL = Cause(
    name="clock-drift",
    title="an instrument's clock runs fast",
    acts_on="timing",
    parameters=(Parameter("rate", "-", 0.0, (-0.02, 0.02), 1e-4, "1e-6 is 1 ppm fast"),),
    source=Source("assumed"),
    how="clock",
    order=4,
    rivals=("dial-gauge-delay", "force-gauge-delay", "drive-delay"),
    key="instrument",
)

clock_drift = replace(
    _ALL,
    variants=(
        replace(_ALL, name="clock-drift/dial_gauge", choice="dial_gauge", senses=_dial),
        replace(_ALL, name="clock-drift/force_gauge", choice="force_gauge", senses=_force),
        replace(_ALL, name="clock-drift/drive", choice="drive", moves=_drive),
    ),
)
