"""Why a run was stopped."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Trip:
    """The first limit that was passed.

    rule: its name ("force", "travel", "speed", "guide range", "stale data", "device flag", "operator", ...).
    what: the fault in one sentence. value, limit: in `unit`, where the rule has numbers.
    arrival: host time at which the block showing the fault arrived, s (monotonic); seen: when the rule said so.
    """

    rule: str
    what: str
    instrument: str = ""
    value: float | None = None
    limit: float | None = None
    unit: str = ""
    arrival: float | None = None
    seen: float | None = None

    def __str__(self) -> str:
        text = f"{self.rule}: {self.what}"
        if self.value is not None and self.limit is not None:
            text += f" ({self.value:.6g} {self.unit} against {self.limit:.6g} {self.unit})"
        return text
