"""The force gauge is an oscillator of its own: y'' + 2 zeta w y' + w^2 y = w^2 F, by the implicit midpoint."""

from __future__ import annotations

import math
from collections.abc import Sequence

from twin.causes._kind import Cause, Survey, Undo, Values, grid, sensor
from twin.parameter import Parameter, Source

PIECES = 6
#: Hz between which a ringing is looked for, in steps by which a weakly damped one is still caught
LOWEST, HIGHEST, CAPTURE = 16.0, 440.0, 1.13


@sensor
def _ring(position, force, simulated, about, p):  # type: ignore[no-untyped-def]
    if p[1] > 2000.0:
        return
    omega = 2.0 * math.pi * p[1]
    h = about[1] / PIECES
    slope = (force[4] - force[0]) / (4.0 * about[1])
    told, rate, old = force[0] - 2.0 * p[2] / omega * slope, slope, force[0]
    a, b = omega * omega, 2.0 * p[2] * omega
    force[0] = told
    for i in range(1, int(about[0])):
        new = force[i]
        for piece in range(PIECES):
            drive = old + (new - old) * (piece + 0.5) / PIECES
            middle = (rate + 0.5 * h * a * (drive - told)) / (1.0 + 0.5 * h * b + 0.25 * h * h * a)
            told += h * middle
            rate = 2.0 * middle - rate
        old = new
        force[i] = told


def _undo(values: Values) -> Undo:
    return Undo(F_lag=values["damping_ratio"] / (math.pi * values["frequency"]))


def _scan(survey: Survey) -> Sequence[Values]:
    steps = round(math.log(HIGHEST / LOWEST) / math.log(CAPTURE))
    frequencies = [LOWEST * (HIGHEST / LOWEST) ** (i / steps) for i in range(steps + 1)]
    return grid({}, frequency=frequencies, damping_ratio=(0.04, 0.2))


force_gauge_resonance = Cause(
    name="force-gauge-resonance",
    title="the force gauge rings",
    acts_on="force-gauge",
    parameters=(
        Parameter("frequency", "Hz", 1000000.0, (8.0, 1000000.0), 20.0, "of the gauge's own oscillation"),
        Parameter("damping_ratio", "-", 0.2, (0.01, 2.0), 0.1, "of it"),
    ),
    source=Source("assumed"),
    how="sensor",
    senses=_ring,
    order=1,
    undo=_undo,
    scan=_scan,
    rivals=("force-gauge-lag", "force-gauge-delay"),
)
