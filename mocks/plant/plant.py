"""A stand that lives: call `advance` with where the drive should go, get what its sensors feel."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocks.plant import march
from mocks.plant.rig import Rig
from mocks.plant.world import World

Float = NDArray[np.float64]

GRID = 50e-6  # s, the plant's own uniform grid
BANDWIDTH = 400.0  # rad/s of the drive's position loop
STRONGEST = 30.0  # m/s^2 that the drive's motor can give


@dataclass(frozen=True, slots=True)
class Slice:
    """A stretch of plant time, n points GRID apart.

    time: s since the plant began. x, u, F: what encoder, dial gauge and force gauge would read, hidden effects in
    them included, noise, sampling and zeros not (u and x from the rest state, F absolute). truth: [n, 11], the
    columns of `march.COLUMNS`.
    """

    time: Float
    x: Float
    u: Float
    F: Float
    truth: Float

    def __len__(self) -> int:
        return len(self.time)


class Plant:
    """One simulated stand from rest on; not thread-safe.

    hidden: effect name -> parameters (those left out take their defaults); KeyError or ValueError where it is wrong.
    """

    def __init__(self, rig: Rig | None = None, hidden: Mapping[str, Mapping[str, float | str]] | None = None) -> None:
        self.world = World.of(rig or Rig(), hidden or {})
        self._record = self.world.record()
        self._tables = self.world.tables.packed()
        self._size = self.world.state_size()
        self._state = march.rest_state(self.world.physics)
        self._bristles, self._contacts = np.zeros(4), np.array([True, True, False, False])
        self._servo, self._target = np.zeros(2), np.zeros(3)
        self._end = np.zeros(2)
        self._step = 0

    @property
    def time(self) -> float:
        """Plant time, s."""
        return self._step * GRID

    def load(self, added_mass: float) -> None:
        """Puts this mass on the weight, instead of what was added before; the plant swings to its new rest."""
        physics, rig = self.world.physics, self.world.rig
        physics.mass += added_mass - rig.added_mass
        self.world.rig = rig.but(added_mass=added_mass)
        self._record["mass"] = physics.mass

    @property
    def drive(self) -> tuple[float, float]:
        """Position and speed of the drive now, m and m/s."""
        return float(self._servo[0]), float(self._servo[1])

    def advance(self, steps: int, position: float, speed: float, acceleration: float = 0.0) -> Slice:
        """`steps` grid steps on, the drive's target moving smoothly from the last one to (position, speed) at the end.

        position in m from the rest position. The servo follows within its means; a jump is followed at STRONGEST.
        """
        goal = np.array([position, speed, acceleration])
        return self.follow(_between(self._target, goal, steps))

    def follow(self, targets: Float) -> Slice:
        """One grid step for each row (x, x', x'') of targets [n, 3]."""
        path = np.empty((len(targets), 2))
        march.servo(self._servo, targets, GRID, BANDWIDTH, STRONGEST, path)
        self._target = targets[-1].copy()
        return self.carry(path)

    def carry(self, path: Float) -> Slice:
        """One grid step for each row (x, x') of path [n, 2], the drive's position as it is, without a servo."""
        n = len(path)
        time = np.asarray((self._step + 1.0 + np.arange(n)) * GRID, dtype=np.float64)
        end = path
        for stage in self.world.drive:
            end = stage(time, end)
        drive: Float = np.concatenate([self._end[None], end])
        truth = np.empty((n, len(march.COLUMNS)))
        march.march(
            self._step * GRID, self._state, self._bristles, self._contacts, drive, GRID, self._record, self._tables,
            self._size, truth,
        )  # fmt: skip
        self._step, self._end = self._step + n, drive[-1].copy()
        return self.sense(time, path[:, 0], truth)

    def fall(self, height: float, steps: int) -> Float:
        """Truth [steps, 11] of a weight let go at rest at `height` m (the rig without pulley and drive)."""
        self._state[0], self._contacts[:2] = height, (height < self.world.physics.rest_stretch, False)
        truth = np.empty((steps, len(march.COLUMNS)))
        march.march(
            self.time, self._state, self._bristles, self._contacts, np.zeros((steps + 1, 2)), GRID, self._record,
            self._tables, self._size, truth,
        )  # fmt: skip
        return truth

    def sense(self, time: Float, x: Float, truth: Float) -> Slice:
        """The truth as the instruments' hidden stages pass it on."""
        if not any(self.world.sensors.values()):
            return Slice(time, x, truth[:, 2], truth[:, 6], truth)
        signals = {"drive_position": x.copy(), "weight_position": truth[:, 2].copy(), "fibre_force": truth[:, 6].copy()}
        for channel, stages in self.world.sensors.items():
            for stage in stages:
                signals[channel] = stage(time, signals[channel], truth)
        return Slice(time, signals["drive_position"], signals["weight_position"], signals["fibre_force"], truth)


def _between(start: Float, goal: Float, steps: int) -> Float:
    """Targets [steps, 3] on the cubic from one (x, x') to another."""
    span = steps * GRID
    share = (np.arange(steps) + 1.0) / steps
    v0, v1, gap = start[1] * span, goal[1] * span, goal[0] - start[0]
    c2, c3 = 3.0 * gap - 2.0 * v0 - v1, v0 + v1 - 2.0 * gap
    x = start[0] + share * (v0 + share * (c2 + share * c3))
    v = (v0 + share * (2.0 * c2 + 3.0 * share * c3)) / span
    path: Float = np.stack([x, v, (2.0 * c2 + 6.0 * share * c3) / span**2], axis=-1)
    return path
