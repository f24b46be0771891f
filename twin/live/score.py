"""What the live twin says after each block."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ChannelScore:
    """One channel, over the run and over the sliding window; NaN while it can't be said.

    R, nrmse: no unit; lag s, above 0 where the simulation is late. short_error: rms over all short windows
    restarted from the measured state; latest_short_error: the newest window's. m for u, N for F.
    """

    R: float
    nrmse: float
    lag: float
    window_R: float
    window_nrmse: float
    window_lag: float
    short_error: float
    latest_short_error: float


@dataclass(frozen=True, slots=True)
class LiveScore:
    """State of the comparison after a block.

    first: index of the first sample in the arrays; time, simulated_u, simulated_F: the samples newly simulated
    (two samples behind the stream, since a slope of x needs them). samples: scored so far. dropped: samples of
    the run that never came. short_windows, passed_over: restarts made, and tenths of a second in which the state
    could not be seen (slack or an impact). load: share of real time that the twin needs; above 1 it falls behind.
    latency: s from the newest sample's arrival to this score, where an arrival was given. notes: in words.
    """

    first: int
    time: Float
    simulated_u: Float
    simulated_F: Float
    u: ChannelScore
    F: ChannelScore
    samples: int
    dropped: int
    short_windows: int
    passed_over: int
    load: float
    latency: float
    notes: tuple[str, ...] = ()
