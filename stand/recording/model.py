"""One run, as everything that reads, compares or diagnoses runs sees it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntFlag
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stand.excitation.spec import Excitation
from stand.setup import Setup, System

Float = NDArray[np.float64]


class Quality(IntFlag):
    """Bits of `/entry/data/quality`: no raw sample within one period for x, u, F; a fault was active."""

    DRIVE_POSITION = 1
    WEIGHT_POSITION = 2
    FIBRE_FORCE = 4
    FAULT = 8


@dataclass(frozen=True, slots=True)
class Channel:
    """A channel's name in the file, its unit there by default, and its letter in the equations."""

    name: str
    unit: str
    symbol: str


X = Channel("drive_position", "m", "x")
U = Channel("weight_position", "m", "u")
F = Channel("fibre_force", "N", "F")
DRIVE_FORCE = Channel("drive_force", "N", "f")

CHANNELS: Mapping[System, tuple[Channel, ...]] = {
    System.WFPD: (X, U, F),
    System.WF: (U, F),
    System.LINEAR_DRIVE: (X, DRIVE_FORCE),
}


@dataclass(frozen=True)
class Recording:
    """One run on a uniform time grid, in SI.

    time: [n], s. channels: name -> [n]. uncertainty: channel -> one sigma per sample, where known.
    quality: uint8 [n] or None. notes: what the reader had to mend or assume, in words for the operator.
    """

    path: Path | None
    setup: Setup
    time: Float
    channels: Mapping[str, Float]
    excitation: Excitation | None = None
    uncertainty: Mapping[str, float] = field(default_factory=dict)
    quality: NDArray[np.uint8] | None = None
    complete: bool | None = None
    notes: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The file's name, or "recording" for one in memory."""
        return self.path.name if self.path else "recording"

    @property
    def dt(self) -> float:
        """The sample interval, s."""
        return float(self.time[-1] - self.time[0]) / (len(self.time) - 1)

    @property
    def x(self) -> Float:
        """Drive position, m [n]."""
        return self.channels[X.name]

    @property
    def u(self) -> Float:
        """Weight position, m [n]."""
        return self.channels[U.name]

    @property
    def F(self) -> Float:
        """Fibre force at the gauge, N [n]."""
        return self.channels[F.name]
