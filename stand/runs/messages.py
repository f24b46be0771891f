"""What a run tells whoever started it: frozen, plain, picklable."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path

from stand.errors import StandError
from stand.safety.trip import Trip

__all__ = ["PHASES", "Failed", "Finished", "Health", "InstrumentHealth", "Outcome", "Phase", "Progress", "Trip"]

#: the phases of a run in their order; a replay has no "prepare", a trip goes straight to "stop"
PHASES = ("connect", "check", "prepare", "rest", "motion", "settle", "stop", "align", "done")


class Outcome(StrEnum):
    """How a run ended; the first is the only one that says that all of it was done."""

    FINISHED = "finished"
    STOPPED = "stopped"
    TRIPPED = "tripped"


@dataclass(frozen=True, slots=True)
class Phase:
    """A phase of PHASES (or a preparation step's) began, at host time `at`, s (monotonic)."""

    name: str
    at: float
    text: str = ""


@dataclass(frozen=True, slots=True)
class Progress:
    """elapsed and total seconds of rest and motion; live blocks published, and dropped by the tap, so far."""

    elapsed: float
    total: float
    published: int
    dropped: int


@dataclass(frozen=True, slots=True)
class InstrumentHealth:
    """state: "ok", "stale" or "lost"; samples decoded so far; rate over the last second, Hz; age of the newest, s.

    skipped: bytes of junk so far; flagged: samples that the device itself called faulty.
    """

    state: str
    samples: int
    rate: float
    age: float
    skipped: int
    flagged: int


@dataclass(frozen=True, slots=True)
class Health:
    """Once a second: every instrument's health."""

    at: float
    instruments: Mapping[str, InstrumentHealth]


@dataclass(frozen=True, slots=True)
class Finished:
    """The end of a run or step. path: the recording, None for a step. why: what ended it early, in words.

    result: a step's findings by name, in SI.
    """

    path: Path | None
    outcome: Outcome
    why: str = ""
    trip: Trip | None = None
    result: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Failed:
    """The run could not be done at all; the parts of a `StandError`. path: the partial recording, if there is one."""

    kind: str
    what: str
    where: str = ""
    value: object = None
    remedy: str = ""
    path: Path | None = None

    def __str__(self) -> str:
        return str(StandError(self.what, where=self.where, value=self.value, remedy=self.remedy))
