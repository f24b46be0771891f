"""The drive's modes of operation: profile position (1), profile velocity (3), homing (6)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mocks.devices.axis import TRAVEL, Axis
from mocks.devices.dictionary import Dictionary
from mocks.devices.trajectory import Ramps

POSITION, VELOCITY, HOMING = 1, 3, 6
NEW_SET_POINT, AT_ONCE, RELATIVE, HALT = 0x10, 0x20, 0x40, 0x100
REACHED, LIMITED, SPECIFIC_12, SPECIFIC_13 = 0x0400, 0x0800, 0x1000, 0x2000
MICRO = 1e-6
WINDOW = 20e-6  # m around the target that counts as reached
FAR = 10.0


@dataclass
class Modes:
    """Acts on the axis with the dictionary's values (um, um/s, um/s^2). origin: travel where the drive's zero lies."""

    axis: Axis
    objects: Dictionary
    origin: float = 0.0
    target: float = math.nan
    waiting: float = math.nan
    acknowledged: bool = False
    limited: bool = False
    homing: str = ""

    def value(self, index: int, sub: int = 0) -> float:
        """An object in SI; rates at least 1 um/s^2."""
        return self.objects.find(index, sub).get() * MICRO

    def rate(self, index: int) -> float:
        """An acceleration, m/s^2, at least 1e-6."""
        return max(self.value(index), MICRO)

    @property
    def ramps(self) -> Ramps:
        """Those of profile position."""
        return Ramps(max(self.value(0x6081), MICRO), self.rate(0x6083), self.rate(0x6084))

    @property
    def soft_limits(self) -> tuple[float, float]:
        """Software limits as travel; wide where both are equal (off)."""
        low, high = self.value(0x607D, 1), self.value(0x607D, 2)
        return (low + self.origin, high + self.origin) if low < high else (-FAR, FAR)

    def reset(self) -> None:
        """Forget what was going on."""
        self.target, self.waiting, self.acknowledged, self.homing = math.nan, math.nan, False, ""

    def command(self, mode: int, word: int, rising: int, falling: int) -> None:
        """A controlword in the enabled drive, with the bits that rose and fell."""
        if rising & HALT:
            self.axis.demand.stop(self.axis.now, self.rate(0x6084))
        if mode == POSITION:
            self._position(word, rising, falling)
        elif mode == VELOCITY and not word & HALT:
            self._velocity()
        elif mode == HOMING:
            self._home(word, rising, falling)

    def _position(self, word: int, rising: int, falling: int) -> None:
        if falling & NEW_SET_POINT:
            self.acknowledged = False
        if falling & HALT and not math.isnan(self.target):
            self._start(self.target)
        if rising & NEW_SET_POINT and not self.acknowledged:
            self._set_point(word)

    def _set_point(self, word: int) -> None:
        base = self.origin
        if word & RELATIVE:
            base = self.axis.demand.state(self.axis.now)[0] if math.isnan(self.target) else self.target
        wanted = base + self.value(0x607A)
        low, high = self.soft_limits
        target = min(max(wanted, low), high)
        self.limited = target != wanted
        self.acknowledged = True
        if word & AT_ONCE or self.axis.standing or word & HALT:
            self.target, self.waiting = target, math.nan
            if not word & HALT:
                self._start(target)
        else:
            self.waiting = target

    def _start(self, target: float) -> None:
        self.target = target
        self.axis.demand.move(self.axis.now, target, self.ramps)

    def _velocity(self) -> None:
        velocity = self.value(0x60FF)
        acceleration, deceleration = self.rate(0x6083), self.rate(0x6084)
        if velocity == 0.0:
            self.axis.demand.stop(self.axis.now, deceleration)
            self.limited = False
            return
        end = self.soft_limits[velocity > 0]
        self.limited = self.axis.run(velocity, acceleration, deceleration, self.rate(0x6085), end)

    def _home(self, word: int, rising: int, falling: int) -> None:
        if falling & NEW_SET_POINT and self.homing in ("seek", "leave"):
            self.homing = ""
            self.axis.demand.stop(self.axis.now, self.rate(0x609A))
        if not rising & NEW_SET_POINT:
            return
        method = self.objects[0x6098]
        if method in (35, 37):
            self._found(self.axis.actual)
        elif method in (17, 18):
            self.homing = "seek"
            self._seek(1.0 if method == 18 else -1.0, 1)
        else:
            self.homing = "failed"

    def _seek(self, sign: float, speed: int) -> None:
        ramps = Ramps(max(self.value(0x6099, speed), MICRO), self.rate(0x609A), self.rate(0x609A))
        self.axis.demand.move(self.axis.now, self.axis.actual + sign * FAR, ramps)

    def _found(self, edge: float) -> None:
        self.origin = edge - self.value(0x607C)
        self.homing = "done"

    def tick(self, mode: int) -> None:
        """After the axis has moved: the next waiting set point, the next leg of homing."""
        if mode == POSITION and self.axis.standing and not math.isnan(self.waiting):
            self._start(self.waiting)
            self.waiting = math.nan
        elif mode == HOMING and self.homing in ("seek", "leave"):
            self._search()

    def _search(self) -> None:
        high = self.objects[0x6098] == 18
        inside = self.axis.actual > TRAVEL if high else self.axis.actual < 0.0
        if self.homing == "seek" and inside:
            self.homing = "leave"
            self._seek(-1.0 if high else 1.0, 2)
        elif self.homing == "leave" and not inside:
            self._found(TRAVEL if high else 0.0)
            self.axis.demand.stop(self.axis.now, self.rate(0x609A))

    def bits(self, mode: int, word: int) -> int:
        """Mode specific bits of the statusword."""
        axis, found = self.axis, LIMITED if self.limited else 0
        if word & HALT:
            return found | (REACHED if axis.standing else 0)
        if mode == POSITION:
            at_target = math.isnan(self.target) or abs(axis.actual - self.target) < WINDOW
            found |= REACHED if axis.standing and at_target and math.isnan(self.waiting) else 0
            found |= SPECIFIC_12 if self.acknowledged or not math.isnan(self.waiting) else 0
        elif mode == VELOCITY:
            found |= REACHED if abs(axis.velocity - self.value(0x60FF)) < 1e-3 else 0
            found |= SPECIFIC_12 if axis.standing and abs(axis.velocity) < 1e-4 else 0
        elif mode == HOMING:
            found |= REACHED if axis.standing and self.homing not in ("seek", "leave") else 0
            found |= SPECIFIC_12 if self.homing == "done" else 0
            found |= SPECIFIC_13 if self.homing == "failed" else 0
        return found
