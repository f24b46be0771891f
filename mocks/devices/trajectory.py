"""The drive's profile generator: trapezoids of velocity from any state to a target, new ones at any time."""

from __future__ import annotations

import math
from bisect import bisect
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocks.devices.kernels import sample_path

Float = NDArray[np.float64]
State = tuple[float, float]
Piece = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Ramps:
    """v_max m/s, acceleration and deceleration m/s^2, all positive."""

    v_max: float
    acceleration: float
    deceleration: float


class Trajectory:
    """Pieces of constant acceleration: rows (time, position, velocity, acceleration); the last one holds on."""

    def __init__(self, time: float, position: float) -> None:
        self.hold(time, position)

    def sample(self, times: Float, origin: float = 0.0) -> Float:
        """(x - origin, x', x'') [n, 3] at rising times [n]."""
        found: Float = sample_path(self.pieces, self.end, times, origin)
        return found

    def state(self, time: float) -> State:
        """Position and velocity at a time."""
        if time >= self.end:
            return self._target, 0.0
        begin, x, v, a = self._rows[max(bisect(self._begins, time) - 1, 0)]
        t = time - begin
        return x + t * (v + 0.5 * a * t), v + a * t

    def done(self, time: float) -> bool:
        """Whether all is at its end by then."""
        return time >= self.end

    def move(self, time: float, target: float, ramps: Ramps) -> None:
        """From the state at `time` to rest at `target`."""
        start = self.state(time)
        self.follow(time, start, move_pieces(start, target, ramps), target)

    def stop(self, time: float, deceleration: float) -> None:
        """From the state at `time` to rest with that deceleration."""
        position, velocity = self.state(time)
        span = abs(velocity) / deceleration
        steps = [(span, -math.copysign(deceleration, velocity))]
        self.follow(time, (position, velocity), steps, position + 0.5 * velocity * span)

    def hold(self, time: float, position: float) -> None:
        """At rest at `position` from `time` on."""
        self._set([(time, position, 0.0, 0.0)])

    def follow(self, time: float, start: State, steps: list[tuple[float, float]], target: float) -> None:
        """From a state at `time` through (duration, acceleration) steps, then at rest at `target`."""
        rows, (x, v) = [], start
        for span, a in steps:
            if span > 0.0:
                rows.append((time, x, v, a))
                x, v, time = x + span * (v + 0.5 * a * span), v + a * span, time + span
        self._set([*rows, (time, target, 0.0, 0.0)])

    def _set(self, rows: list[Piece]) -> None:
        self._rows, self._begins, self._target = rows, [row[0] for row in rows], rows[-1][1]
        self.pieces, self.end = np.array(rows), rows[-1][0]


def move_pieces(start: State, target: float, ramps: Ramps) -> list[tuple[float, float]]:
    """(duration, acceleration) of the quickest trapezoid from (position, velocity) to rest at target."""
    position, velocity = start
    acc, dec, v_max = ramps.acceleration, ramps.deceleration, ramps.v_max
    sign = math.copysign(1.0, target - position - velocity * abs(velocity) / (2.0 * dec))
    distance, v = sign * (target - position), sign * velocity
    pieces = []
    if v < 0.0:
        pieces.append((-v / dec, dec))
        distance, v = distance + v * v / (2.0 * dec), 0.0
    peak = min(v_max, math.sqrt(max(0.0, 2.0 * acc * dec * distance + dec * v * v) / (acc + dec)))
    if peak >= v:
        pieces.append(((peak - v) / acc, acc))
        distance -= (peak * peak - v * v) / (2.0 * acc)
    else:
        pieces.append(((v - peak) / dec, -dec))
        distance -= (v * v - peak * peak) / (2.0 * dec)
    cruise = distance - peak * peak / (2.0 * dec)
    if peak > 0.0 and cruise > 0.0:
        pieces.append((cruise / peak, 0.0))
    pieces.append((peak / dec, -dec))
    return [(span, sign * a) for span, a in pieces]
