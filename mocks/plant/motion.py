"""Drive motions, jerk limited: what an operator orders, as targets on the plant's grid."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

SPEED, ACCELERATION, JERK = 1.0, 12.0, 400.0
REST = 1.0  # s before and after
SHAPES = ("rectangular", "trapezoidal", "quasi-sinusoidal", "release")


@dataclass(frozen=True)
class Motion:
    """frequency Hz, amplitude m peak to peak, ramp s (trapezoid), added_mass kg; cycles follow from the time."""

    shape: str
    frequency: float = 0.0
    amplitude: float = 0.0
    ramp: float = 0.0
    added_mass: float = 0.0
    drop_height: float = 0.0

    def cycles(self, seconds: float) -> int:
        """Whole cycles that fit between the rests."""
        spare = 0.5 if self.shape == "quasi-sinusoidal" else 0.0
        cycles = int((seconds - 2.0 * REST) * self.frequency - spare + 1e-9)
        if cycles < 1:
            raise ValueError(f"{seconds} s leave no whole cycle of {self.frequency} Hz between two rests of {REST} s")
        return cycles

    def ordered(self, seconds: float) -> dict[str, float | str]:
        """What a recording's excitation states."""
        stated = {k: v for k, v in asdict(self).items() if k != "added_mass" and v}
        return stated if self.shape == "release" else stated | {"cycles": self.cycles(seconds)}


ADDED = 5.035
SITUATIONS = {
    "2": Motion("trapezoidal", 1.25, 0.030, 0.20),
    "3c": Motion("trapezoidal", 2.0, 0.020, 0.125),
    "7a": Motion("trapezoidal", 1.25, 0.030, 0.20, ADDED),
    "10": Motion("trapezoidal", 2.0, 0.012, 0.125, ADDED),
    "11": Motion("quasi-sinusoidal", 0.35, 0.090),
    "gentle": Motion("trapezoidal", 1.0, 0.040, 0.35),
    "sine": Motion("quasi-sinusoidal", 1.5, 0.030),
    "strong": Motion("trapezoidal", 1.5, 0.058, 0.20),
    "strong-added": Motion("trapezoidal", 1.25, 0.050, 0.20, ADDED),
    "rectangular": Motion("rectangular", 1.0, 0.040),
    "rectangular-added": Motion("rectangular", 0.8, 0.030, 0.0, ADDED),
}


def targets(motion: Motion, seconds: float, grid: float) -> Float:
    """Rows (x, x', x'') float64 [seconds/grid, 3] at grid, 2 grid, ...; ValueError beyond the drive's limits."""
    time = np.linspace(grid, seconds, round(seconds / grid)) - REST
    path = _sine(motion, seconds, time) if motion.shape == "quasi-sinusoidal" else _ramps(motion, seconds, time)
    for column, limit, what in ((1, SPEED, "speed"), (2, ACCELERATION, "acceleration")):
        most = float(np.abs(path[:, column]).max())
        if most > limit * (1.0 + 1e-9):
            raise ValueError(f"{motion} needs a {what} of {most:.3g}, the drive gives {limit:.3g}")
    return path


def _sine(motion: Motion, seconds: float, time: Float) -> Float:
    """A cosine whose phase is eased in and out over half a period."""
    omega, ease = 2.0 * math.pi * motion.frequency, 0.5 / motion.frequency
    end = (motion.cycles(seconds) + 0.5) / motion.frequency
    inward = np.clip(np.minimum(time, end - time) / ease, 0.0, 1.0)
    rate = omega * (3.0 * inward**2 - 2.0 * inward**3)
    drift = np.where(time < 0.5 * end, 1.0, -1.0) * omega * 6.0 * (inward - inward**2) / ease
    eased = omega * ease * (inward**3 - 0.5 * inward**4)
    beyond = np.maximum(np.minimum(time, end - time) - ease, 0.0) * omega
    phase = np.where(time < 0.5 * end, eased + beyond, -(eased + beyond))
    half = 0.5 * motion.amplitude
    x = half * (1.0 - np.cos(phase))
    v = half * np.sin(phase) * rate
    a = half * (np.cos(phase) * rate**2 + np.sin(phase) * drift)
    return np.stack([x, v, a], axis=-1)


def _ramps(motion: Motion, seconds: float, time: Float) -> Float:
    """Up, hold, down, hold."""
    knots = _given(motion) if motion.shape == "trapezoidal" else _fastest(motion.amplitude)
    if knots[-1, 0] > 0.5 / motion.frequency:
        raise ValueError(f"{motion} has no time for its ramp of {knots[-1, 0]:.3g} s")
    cycle = np.floor(time * motion.frequency)
    within = time - cycle / motion.frequency
    down = within >= 0.5 / motion.frequency
    rise = _along(knots, np.where(down, within - 0.5 / motion.frequency, within))
    path = np.where(down[:, None], np.array([motion.amplitude, 0.0, 0.0]) - rise, rise)
    path[(cycle < 0) | (cycle >= motion.cycles(seconds))] = 0.0
    return path


def _given(motion: Motion) -> Float:
    """Four phases of equal length that take the whole ramp: the least acceleration and jerk."""
    jerk = 32.0 * motion.amplitude / motion.ramp**3
    if jerk > JERK * (1.0 + 1e-9):
        raise ValueError(f"{motion} needs a jerk of {jerk:.3g}, the drive gives {JERK:.3g}")
    return _knots([0.25 * motion.ramp] * 4, [jerk, -jerk, -jerk, jerk])


def _fastest(distance: float) -> Float:
    """The fastest rest-to-rest move within speed, acceleration and jerk: up to seven phases."""
    edge = min(ACCELERATION / JERK, (distance / (2.0 * JERK)) ** (1.0 / 3.0))
    a = JERK * edge
    flat = max(0.0, 0.5 * (math.sqrt(edge**2 + 4.0 * distance / a) - 3.0 * edge))
    flat = min(flat, SPEED / a - edge)
    cruise = max(0.0, distance / (a * (edge + flat)) - (2.0 * edge + flat))
    return _knots([edge, flat, edge, cruise, edge, flat, edge], [JERK, 0, -JERK, 0, -JERK, 0, JERK])


def _knots(durations: list[float], jerks: list[float]) -> Float:
    """Rows (t, x, x', x'', jerk) where each phase begins, and the end."""
    rows = [np.array([0.0, 0.0, 0.0, 0.0, jerks[0]])]
    for i, (T, j) in enumerate(zip(durations, jerks, strict=True)):
        t, x, v, a, _ = rows[-1]
        following = jerks[i + 1] if i + 1 < len(jerks) else 0.0
        rows[-1][4] = j
        x, v, a = x + T * (v + T * (a / 2.0 + T * j / 6.0)), v + T * (a + T * j / 2.0), a + T * j
        rows.append(np.array([t + T, x, v, a, following]))
    rows[-1][2:] = 0.0
    return np.stack(rows)


def _along(knots: Float, time: Float) -> Float:
    """Rows (x, x', x'') on the piecewise cubic at `time`."""
    i = np.clip(np.searchsorted(knots[:, 0], time, side="right") - 1, 0, len(knots) - 1)
    t0, x, v, a, j = knots[i].T
    t = np.maximum(time - t0, 0.0)
    return np.stack([x + t * (v + t * (a / 2 + t * j / 6)), v + t * (a + t * j / 2), a + t * j], axis=-1)
