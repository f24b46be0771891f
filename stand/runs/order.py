"""What the acquisition process is asked to do."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from enum import StrEnum
from pathlib import Path

from stand.excitation.spec import Excitation
from stand.setup import Setup


@dataclass(frozen=True)
class RunOrder:
    """One run. setup: None for the stand's own; folder: None for the stand's storage.

    prepare: go to the rest position first; else the drive must be there. home: find its reference before that,
    which a drive that has lost it (or never had it since power-on) needs.
    replay: nothing is commanded, `seconds` are recorded; `speed` is the replay's (0: as fast as possible);
    inject: the recording whose arrivals replace those measured, after its content was found equal.
    """

    excitation: Excitation | None = None
    setup: Setup | None = None
    folder: Path | None = None
    name: str = ""
    comment: str = ""
    operator: str = ""
    prepare: bool = True
    home: bool = False
    replay: bool = False
    seconds: float = 0.0
    speed: float = 1.0
    inject: Path | None = None

    def file_name(self, now: datetime | None = None) -> str:
        """`<UTC timestamp>_<shape>_<freq>Hz.h5`, or the order's own name."""
        if self.name:
            return self.name if self.name.endswith(".h5") else f"{self.name}.h5"
        stamp = (now or datetime.now(UTC)).strftime("%Y%m%dT%H%M%S.%fZ")
        stamp = f"{stamp[:-5]}Z"
        if self.excitation is None:
            return f"{stamp}_replay.h5"
        return f"{stamp}_{self.excitation.shape}_{self.excitation.frequency:g}Hz.h5"


class Step(StrEnum):
    """The preparation steps that can be asked for alone."""

    STATUS = "status"
    HOME = "home"
    JOG = "jog"
    TARE = "tare"
    REST_CHECK = "rest-check"
    RESET = "reset"


@dataclass(frozen=True)
class StepOrder:
    """One preparation step. distance m and speed m/s are for a jog."""

    step: Step
    distance: float = 0.0
    speed: float = 0.02
    setup: Setup | None = None


Order = RunOrder | StepOrder
