"""Running scores of one channel."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from twin.live.score import ChannelScore
from twin.score import best_lag
from twin.score.channel import nrmse
from twin.score.stream import SlidingR, StreamR

Float = NDArray[np.float64]

#: the lag over the run uses at most this many of its last samples, so that a long run does not slow it
LONGEST = 1 << 15


class ChannelTrack:
    """R, NRMSE and lag over the run and over a window, block by block."""

    def __init__(self, window: int, dt: float) -> None:
        self._run, self._window, self._dt = StreamR(), SlidingR(window), dt
        self._R = self._window_R = self._lag = self._window_lag = math.nan

    def push(self, measured: Float, simulated: Float) -> None:
        """Takes the samples newly simulated."""
        self._R = self._run.push(measured, simulated)
        self._window_R = self._window.push(measured, simulated)

    def update_lag(self, measured: Float, simulated: Float) -> None:
        """Finds the lag over the run (the whole of it, or its last 16 s) and over the window."""
        self._lag = best_lag(measured[-LONGEST:], simulated[-LONGEST:], self._dt)
        self._window_lag = best_lag(*self._window.samples(), self._dt)

    def score(self, short: Float) -> ChannelScore:
        """The scores now; short: rms of each short window so far."""
        total = float(np.sqrt(np.mean(short * short))) if len(short) else math.nan
        window = self._window.samples()
        return ChannelScore(
            R=self._R,
            nrmse=self._run.nrmse,
            lag=self._lag,
            window_R=self._window_R,
            window_nrmse=nrmse(*window) if len(window[0]) else math.nan,
            window_lag=self._window_lag,
            short_error=total,
            latest_short_error=float(short[-1]) if len(short) else math.nan,
        )
