"""Running scores of one channel; what a block costs does not grow with the run."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from twin.live.lag import StreamLag
from twin.live.score import ChannelScore
from twin.live.short import Errors
from twin.score import best_lag
from twin.score.stream import SlidingR, StreamR

Float = NDArray[np.float64]


class ChannelTrack:
    """R, NRMSE and lag over the run and over a window, block by block."""

    def __init__(self, window: int, dt: float) -> None:
        self._run, self._window, self._shifts, self._dt = StreamR(), SlidingR(window), StreamLag(dt), dt
        self._R = self._window_R = self._lag = self._window_lag = math.nan

    def push(self, measured: Float, simulated: Float) -> None:
        """Takes the samples newly simulated."""
        self._R = self._run.push(measured, simulated)
        self._window_R = self._window.push(measured, simulated)
        self._shifts.push(measured, simulated)

    def update_lag(self) -> None:
        """Finds the lag over the run and over the window."""
        self._lag = self._shifts.lag
        self._window_lag = best_lag(*self._window.samples(), self._dt)

    def score(self, short: Errors) -> ChannelScore:
        """The scores now; short: the short windows so far."""
        return ChannelScore(
            R=self._R,
            nrmse=self._run.nrmse,
            lag=self._lag,
            window_R=self._window_R,
            window_nrmse=self._window.nrmse,
            window_lag=self._window_lag,
            short_error=short.rms,
            latest_short_error=short.latest,
        )
