"""A displacement as a function of time, and the step that all shapes with flanks are made of."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from stand.config import Limits
from stand.excitation.spec import Excitation, Shape

Float = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Peaks:
    """Largest magnitudes of speed m/s, acceleration m/s^2 and jerk m/s^3."""

    speed: float
    acceleration: float
    jerk: float


@dataclass(frozen=True)
class Curve:
    """duration s, from rest to rest. evaluate(t): float64 [4, n], x m, x', x'', x''' at t in [0, duration]."""

    duration: float
    peaks: Peaks
    span: tuple[float, float]
    evaluate: Callable[[Float], Float]


@dataclass(frozen=True)
class Waveform:
    """A plug-in: one shape. build(excitation, limits): its curve, or InputError where it can't be drawn at all."""

    shape: Shape
    title: str
    source: str
    build: Callable[[Excitation, Limits], Curve]


@dataclass(frozen=True, slots=True)
class Step:
    """From 0 to `height` in three moving averages: stroke over speed, speed over acceleration, that over jerk, s."""

    height: float
    times: tuple[float, float, float]

    @property
    def duration(self) -> float:
        """Seconds from rest to rest."""
        return sum(self.times)

    @property
    def peaks(self) -> Peaks:
        """Speed, acceleration, jerk; the jerk doubles where speeding up meets slowing down."""
        long, middle, short = sorted(self.times, reverse=True)
        speed = abs(self.height) / long
        meets = 2.0 if long < (middle + short) * (1 - 1e-9) else 1.0
        return Peaks(speed, speed / middle, meets * speed / (middle * short))

    def evaluate(self, t: Float) -> Float:
        """x, x', x'', x''' [4, n]: sums of (t - t_s)+^k over the eight corners."""
        t = np.clip(t, 0.0, self.duration)
        factor = self.height / float(np.prod(self.times))
        out = np.zeros((4, *t.shape))
        for size in range(4):
            for subset in combinations(self.times, size):
                since = np.maximum(t - sum(subset), 0.0)
                sign = factor * (-1.0) ** size
                out += sign * np.stack((since**3 / 6, since**2 / 2, since, (since > 0) * 1.0))
        out[:, t >= self.duration] = np.array([[self.height], [0.0], [0.0], [0.0]])
        return out


def shaped_step(height: float, duration: float) -> Step:
    """A step in `duration` s with half of it at nominal speed: averages of 0.5, 0.3 and 0.2 of the duration."""
    return Step(height, (0.5 * duration, 0.3 * duration, 0.2 * duration))


def fastest_step(height: float, limits: Limits, share: float = 0.95) -> Step:
    """The quickest step within `share` of the limits of speed, acceleration and jerk."""
    speed, acceleration, jerk = (share * v for v in (limits.speed, limits.acceleration, limits.jerk))
    ramp = acceleration / jerk
    top = acceleration / 2 * (math.sqrt(ramp**2 + 4 * height / acceleration) - ramp)
    top = min(top, speed)
    if top >= acceleration * ramp:
        return Step(height, (height / top, top / acceleration, ramp))
    top = min((height * math.sqrt(jerk) / 2) ** (2 / 3), speed)
    ramp = math.sqrt(top / jerk)
    return Step(height, (height / top, ramp, ramp))


def train(begins: list[float], up: Step) -> Callable[[Float], Float]:
    """Steps that begin at ascending times, up and down in turn, none before the one before it has ended."""
    starts = np.array(begins)

    def evaluate(t: Float) -> Float:
        number = np.searchsorted(starts, t, "right") - 1
        out = up.evaluate(np.where(number >= 0, t - starts[np.maximum(number, 0)], 0.0))
        down = number % 2 == 1
        out[:, down] *= -1.0
        out[0, down] += up.height
        out[:, number < 0] = 0.0
        return out

    return evaluate
