"""Shapes that go up and down by steps, once a cycle."""

from __future__ import annotations

import math
from collections.abc import Callable

from stand.errors import InputError
from stand.excitation.curve import Curve, Step, train
from stand.excitation.spec import Excitation


def up_and_down(excitation: Excitation, step: Callable[[float], Step]) -> Curve:
    """Up at the beginning of each cycle, down at its middle. step(height) makes a flank."""
    up = step(excitation.amplitude)
    half = 0.5 / excitation.frequency
    if up.duration > half * (1 + 1e-9):
        largest = math.floor(500 / up.duration) / 1000
        remedy = f"At most {largest:g} Hz with a flank of {up.duration * 1e3:.4g} ms"
        raise InputError(
            "a flank does not fit half a cycle", where="frequency", value=excitation.frequency, remedy=remedy
        )
    count = round(excitation.cycles)
    begins = [k * half for k in range(2 * count)]
    duration = count / excitation.frequency
    return Curve(duration, up.peaks, (0.0, excitation.amplitude), train(begins, up))
