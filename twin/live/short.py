"""Short-window prediction error beside the run."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.setup import Setup
from twin.kernels.hermite import drive_table
from twin.live.columns import Columns
from twin.model import FibreModel
from twin.score.windows import HALF, WINDOW, next_start, window_error

Float = NDArray[np.float64]


@dataclass(slots=True)
class Errors:
    """One channel's windows so far: how many, the sum of their squared rms, the latest rms."""

    count: int = 0
    squares: float = 0.0
    latest: float = math.nan

    def add(self, rms: float) -> None:
        """One window more."""
        self.count, self.squares, self.latest = self.count + 1, self.squares + rms * rms, rms

    @property
    def rms(self) -> float:
        """Over all of them; NaN without one."""
        return math.sqrt(self.squares / self.count) if self.count else math.nan


class ShortWindows:
    """Restarts the model in each tenth of a second, once the samples that it needs are there."""

    def __init__(self, setup: Setup, model: FibreModel, constants: Float, dt: float) -> None:
        self._setup, self._model, self._constants, self._dt = setup, model, constants, dt
        self._span, self._begin = round(WINDOW / dt), 0
        self.u, self.F = Errors(), Errors()
        self.passed_over = 0

    def follow(self, raw: Columns, gaps: list[int]) -> None:
        """Makes every restart whose samples have come since the last call; none across a gap."""
        margin = 2 * HALF + 1
        while raw.count >= self._begin + 2 * self._span + margin:
            low, high = max(0, self._begin - margin), self._begin + 2 * self._span + margin
            self._one(raw, low, high, any(low < gap < high for gap in gaps))
            self._begin += self._span

    def _one(self, raw: Columns, low: int, high: int, broken: bool) -> None:
        u, F = raw["u"][low:high], raw["F"][low:high]
        at = None if broken else next_start(F, self._begin - low, self._begin - low + self._span)
        if at is None:
            self.passed_over += 1
            return
        drive = drive_table(raw["x"][low:high], self._dt)
        made = (self._setup, self._model, self._constants, drive, u, F)
        found = window_error(*made, at, self._dt, self._span)
        self.u.add(found.u)
        self.F.add(found.F)
