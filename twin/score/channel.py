"""One channel's scores over one stretch of samples."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.score.lag import best_lag

Float = NDArray[np.float64]


def pearson(measured: Float, simulated: Float) -> float:
    """R(p), Pearson's coefficient (S0 eq. 1, S1 eq. 2); NaN where either series does not move."""
    a, b = measured - measured.mean(), simulated - simulated.mean()
    scale = math.sqrt(dot(a, a)) * math.sqrt(dot(b, b))
    return dot(a, b) / scale if scale > 0.0 else math.nan


def dot(a: Float, b: Float) -> float:
    """Their inner product, pairwise summed, without the threads that BLAS would wake for it."""
    return float(np.sum(a * b))


def psi(measured: Float, simulated: Float) -> float:
    """psi(p) = (1 - R)^2 (S1 eq. 3), what the papers' tuning makes small."""
    return (1.0 - pearson(measured, simulated)) ** 2


def nrmse(measured: Float, simulated: Float) -> float:
    """rms(simulated - measured) / (max - min of measured); NaN where the measured series does not move."""
    span = float(np.ptp(measured))
    return math.sqrt(float(np.mean((simulated - measured) ** 2))) / span if span > 0.0 else math.nan


def gain(measured: Float, simulated: Float) -> float:
    """The slope of the least-squares line of simulated on measured."""
    a = measured - measured.mean()
    power = dot(a, a)
    return dot(a, simulated - simulated.mean()) / power if power > 0.0 else math.nan


@dataclass(frozen=True, slots=True)
class Score:
    """R, psi, nrmse and gain have no unit; lag in s, above 0 where the simulation is late; the rest in the channel's.

    peak_error is the largest |simulated - measured|; peak_measured and peak_simulated are the largest values.
    """

    R: float
    psi: float
    nrmse: float
    lag: float
    gain: float
    peak_error: float
    peak_measured: float
    peak_simulated: float

    def to_json(self) -> dict[str, float | None]:
        """Keys of `verdict.md`; what is undefined is null."""
        names = {"lag": "lag_s"}
        values = {names.get(name, name): getattr(self, name) for name in self.__slots__}
        return {name: value if math.isfinite(value) else None for name, value in values.items()}


def score(measured: Float, simulated: Float, dt: float) -> Score:
    """All scores of one channel, [n] against [n] on one uniform grid of dt seconds."""
    R = pearson(measured, simulated)
    return Score(
        R=R,
        psi=(1.0 - R) ** 2,
        nrmse=nrmse(measured, simulated),
        lag=best_lag(measured, simulated, dt),
        gain=gain(measured, simulated),
        peak_error=float(np.max(np.abs(simulated - measured))),
        peak_measured=float(np.max(measured)),
        peak_simulated=float(np.max(simulated)),
    )
