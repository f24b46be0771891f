"""The axis: a demand that is generated, an actual position that follows, switches at the ends of the travel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocks.devices.trajectory import Ramps, Trajectory

Float = NDArray[np.float64]

TRAVEL = 0.100  # m between the end switches
OVERTRAVEL = 0.3e-3  # m beyond a switch at which the drive brakes by itself
BRAKE = 20.0  # m/s^2 of the holding brake that falls when the power stage goes off


@dataclass
class Axis:
    """Positions are travel, m, 0 at the negative end switch.

    rest: travel at which the plant's x is zero. frozen_until: true time up to which the axis is jammed.
    """

    rest: float
    now: float
    frozen_until: float = -np.inf

    def __post_init__(self) -> None:
        self.demand = Trajectory(self.now, self.rest)
        self.actual, self.velocity = self.rest, 0.0

    def targets(self, times: Float) -> Float:
        """What the plant's servo gets: (x, x', x'') [n, 3]."""
        if times[0] < self.frozen_until:
            return np.tile([self.actual - self.rest, 0.0, 0.0], (len(times), 1))
        return self.demand.sample(times, self.rest)

    def moved(self, times: Float, position: Float) -> Float:
        """The plant's answer; returns it as travel [n]."""
        travel = position + self.rest
        before, span = self.actual, float(times[-1]) - self.now
        self.velocity = (float(travel[-1]) - before) / span if span > 0 else self.velocity
        self.actual, self.now = float(travel[-1]), float(times[-1])
        return travel

    @property
    def error(self) -> float:
        """Following error, demand minus actual, m."""
        return self.demand.state(self.now)[0] - self.actual

    @property
    def standing(self) -> bool:
        """Whether the demand has come to rest."""
        return self.demand.done(self.now)

    @property
    def switches(self) -> int:
        """Digital inputs: bit 0 negative end switch, bit 1 positive, bit 2 home (the negative one)."""
        low, high = self.actual < 0.0, self.actual > TRAVEL
        return low | high << 1 | low << 2

    @property
    def overrun(self) -> bool:
        """Whether it is beyond an end switch and on its way out."""
        _, velocity = self.demand.state(self.now)
        return (self.actual < -OVERTRAVEL and velocity < 0) or (self.actual > TRAVEL + OVERTRAVEL and velocity > 0)

    def run(self, velocity: float, acceleration: float, deceleration: float, braking: float, end: float) -> bool:
        """Ramp to a velocity and keep it until braking (m/s^2) must begin for `end` (travel); whether end limits it."""
        x, v = self.demand.state(self.now)
        steps, x1 = _ramp(x, v, velocity, acceleration, deceleration)
        sign = 1.0 if velocity > 0 else -1.0
        left = sign * (end - x1) - velocity * velocity / (2.0 * braking)
        if left < 0.0:
            speed = max(abs(velocity), abs(v), 1e-6)
            self.demand.move(self.now, end, Ramps(speed, braking, braking))
            return True
        steps += [(left / abs(velocity), 0.0), (abs(velocity) / braking, -sign * braking)]
        self.demand.follow(self.now, (x, v), steps, end)
        return False


def _ramp(
    x: float, v: float, goal: float, acceleration: float, deceleration: float
) -> tuple[list[tuple[float, float]], float]:
    """(duration, acceleration) pieces from v to goal, through zero where the sign changes, and the position then."""
    stages = [goal] if v * goal >= 0.0 else [0.0, goal]
    steps = []
    for target in stages:
        rate = acceleration if abs(target) > abs(v) else deceleration
        span = abs(target - v) / rate
        steps.append((span, rate if target > v else -rate))
        x, v = x + 0.5 * (v + target) * span, target
    return steps, x
