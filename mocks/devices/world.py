"""The plant in real time: advanced to now whenever somebody looks, with its recent past on a fine grid."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mocks.devices.kernels import keep, look_up
from mocks.plant.plant import GRID, Plant, Slice

Float = NDArray[np.float64]

#: rows of what is kept: drive; weight and force as sensed and as they are
X, U, TRUE_U, F, TRUE_F = range(5)
WEIGHT, FORCE = slice(1, 3), slice(3, 5)
CHUNK = 120
_KEPT = 40_000


class Mover(Protocol):
    """What moves the plant: targets (x, x', x'') [n, 3] at times [n], and what it makes of the outcome."""

    def targets(self, times: Float) -> Float: ...
    def moved(self, times: Float, position: Float) -> None: ...


class World:
    """Not thread-safe: whoever calls holds the stand's lock. Times are true times, s (CLOCK_MONOTONIC)."""

    def __init__(self, plant: Plant, start: float) -> None:
        self.plant, self.start = plant, start
        self._kept = np.zeros((5, 2 * _KEPT))
        self._kept[F] = self._kept[TRUE_F] = plant.world.physics.rest_tension
        self._end, self._steps = _KEPT, 0
        self.mover: Mover | None = None

    @property
    def now(self) -> float:
        """How far the plant has come."""
        return self.start + self._steps * GRID

    def advance(self, now: float) -> None:
        """On to the first grid point that is not before `now`."""
        while (steps := math.ceil((now - self.start) / GRID - self._steps - 1e-9)) > 0:
            self._advance(min(steps, CHUNK))

    def _advance(self, steps: int) -> None:
        times: Float = self.now + GRID * np.arange(1.0, steps + 1)
        targets = self.mover.targets(times) if self.mover else np.zeros((steps, 3))
        run = self.plant.follow(targets)
        self._keep(run)
        self._steps += steps
        if self.mover:
            self.mover.moved(times, run.x)

    def _keep(self, run: Slice) -> None:
        n = len(run)
        if self._end + n > self._kept.shape[1]:
            self._kept[:, :_KEPT] = self._kept[:, self._end - _KEPT : self._end]
            self._end = _KEPT
        keep(self._kept, self._end, run.x, run.u, run.truth[:, 2], run.F, run.truth[:, 6])
        self._end += n

    def load(self, mass: float) -> None:
        """Another added mass, kg, from now on."""
        self.plant.load(mass)

    def at(self, channels: slice, times: Float) -> Float:
        """Two channels [2, n] at times [n], straight between grid points; ValueError for a time that is not kept."""
        shift = self._steps - self._end + 1
        first, last = ((float(t) - self.start) / GRID - shift for t in (times[0], times[-1]))
        if not (self._end - _KEPT <= first and last <= self._end - 1 + 1e-6):
            kept = f"the plant is at {self.now:.6f} s and keeps {_KEPT * GRID:g} s"
            raise ValueError(f"{kept}; asked for {times[0]:.6f} to {times[-1]:.6f} s")
        values = np.empty((2, len(times)))
        look_up(self._kept, channels.start, times, self.start, GRID, float(shift), self._end - 2, values)
        return values

    def pair(self, channels: slice, times: Float) -> tuple[Float, Float]:
        """Two channels at times [n]."""
        first, second = self.at(channels, times)
        return first, second
