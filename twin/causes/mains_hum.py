"""The mains in a signal: a line that the signal has at rest and no other signal answers."""

from __future__ import annotations

from dataclasses import replace

from twin.causes._kind import Cause
from twin.parameter import Parameter, Source

_ALL = Cause(
    name="mains-hum",
    title="the mains sing in a signal",
    acts_on="wiring",
    parameters=(
        Parameter("amplitude", "-", 0.0, (0.0, 1e3), 0.1, "in the signal's unit"),
        Parameter("frequency", "Hz", 50.0, (10.0, 1000.0), 0.5, "of the line"),
    ),
    source=Source("assumed"),
    how="line",
    key="signal",
)

mains_hum = replace(
    _ALL,
    variants=tuple(
        replace(_ALL, name=f"mains-hum/{signal}", choice=signal)
        for signal in ("fibre_force", "weight_position", "drive_position")
    ),
)
