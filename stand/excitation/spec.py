"""The excitation as the operator orders it and as a recording states it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Shape(StrEnum):
    """The shapes of `recording.md`."""

    RECTANGULAR = "rectangular"
    TRAPEZOIDAL = "trapezoidal"
    QUASI_SINUSOIDAL = "quasi-sinusoidal"
    RELEASE = "release"


@dataclass(frozen=True, slots=True)
class Excitation:
    """frequency Hz; amplitude m, peak to peak; ramp s, for a trapezoid; cycles; drop_height m, for a release."""

    shape: Shape
    frequency: float = 0.0
    amplitude: float = 0.0
    ramp: float = 0.0
    cycles: float = 0.0
    drop_height: float = 0.0

    @property
    def duration(self) -> float:
        """Seconds of motion, without the rest before and after."""
        return self.cycles / self.frequency if self.frequency else 0.0
