"""An instrument's clock that runs fast: it tells at t what was at t/(1 + rate)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from twin.causes._delay import delay_line
from twin.causes._kind import Cause, Undo, Values, drive_input, sensor
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


def _late(values: Values) -> float:
    return values["rate"] / (1.0 + values["rate"])


_HOOKS: dict[str, dict[str, Any]] = {
    "dial_gauge": {"senses": _dial, "undo": lambda values: Undo(u_drift=_late(values))},
    "force_gauge": {"senses": _force, "undo": lambda values: Undo(F_drift=_late(values))},
    "drive": {"moves": _drive},
}


def _others(instrument: str) -> tuple[str, ...]:
    """Two clocks that run alike are the third's fault; then the delays."""
    return (*(f"clock-drift/{other}" for other in _HOOKS if other != instrument), *_ALL.rivals)


clock_drift = replace(
    _ALL,
    variants=tuple(
        replace(_ALL, name=f"clock-drift/{own}", choice=own, rivals=_others(own), **hook)
        for own, hook in _HOOKS.items()
    ),
)
