"""What the time base takes and gives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

RATE = 2000.0


@dataclass(frozen=True)
class GaugeStream:
    """A gauge's raw stream as stored: uint8 [b]; of each read, its time s [k] and its number of bytes [k]."""

    raw: NDArray[np.uint8]
    arrival_time: Float
    arrival_bytes: NDArray[np.int64]


@dataclass(frozen=True)
class RingStream:
    """The drive's polls as stored: uint16 [k, n]; times before the question and after the answer, s [k]."""

    registers: NDArray[np.uint16]
    request_time: Float
    response_time: Float


Streams = Mapping[str, GaugeStream | RingStream]


@dataclass(frozen=True, slots=True)
class Clock:
    """An instrument's clock: sample k was taken at offset + k * period on the host's clock, s.

    drift: rate against nominal, 1e-6 is 1 ppm fast. residual: how far arrivals lie above the fit, median, s.
    fit_sigma: of the fit alone; sigma: with the latency's uncertainty; one sigma of a sample's time, s.
    method: "ring", "ticks" (a periodic timer's bunches) or "envelope" (earliest arrivals).
    """

    offset: float
    period: float
    drift: float
    residual: float
    fit_sigma: float
    sigma: float
    latency: float
    method: str

    def time_of(self, index: Float | float) -> Float:
        """Host time of samples by their index, s."""
        return np.asarray(self.offset + self.period * np.asarray(index, dtype=np.float64))


@dataclass(frozen=True, slots=True)
class Loss:
    """Samples that never arrived: the index of the first one, its time on the host's clock s, how many."""

    instrument: str
    index: int
    time: float
    count: int


@dataclass(frozen=True)
class Aligned:
    """Three channels on one uniform grid.

    time: [n], s from `origin` (host's monotonic clock). channels: drive_position, weight_position (relative to the
    rest at the beginning; `zeros` holds what was subtracted), fibre_force, [n]. quality: uint8 [n].
    uncertainty: channel -> achieved one sigma per sample. counts: instrument -> samples, junk bytes, overruns.
    derived: channels interpolated from plain polls, not from counted samples.
    """

    origin: float
    time: Float
    channels: Mapping[str, Float]
    quality: NDArray[np.uint8]
    uncertainty: Mapping[str, float]
    clocks: Mapping[str, Clock]
    zeros: Mapping[str, float]
    losses: tuple[Loss, ...] = ()
    counts: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    derived: frozenset[str] = frozenset()


@dataclass(frozen=True)
class LiveBlock:
    """Grid samples as they become known, for screens and the live model; good to about 1 ms.

    first: grid index. time [n] s from the run's origin; x, u m; F N [n]; quality [n]. newest_arrival: host time of the
    newest read that went into it, s.
    """

    first: int
    time: Float
    x: Float
    u: Float
    F: Float
    quality: NDArray[np.uint8]
    newest_arrival: float
