"""What stands between a true signal and what is recorded of it: small streaming stages on the plant's grid.

A `Stage` is called as stage(time [n], signal [n], truth [n, 11]) and returns the signal as it leaves; a `DriveStage`
as stage(time [n], path [n, 2]) with position and speed. Both keep what they need from block to block; at the first
block the stand is taken to have been at rest for ever.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable

import numpy as np
from numba import njit
from numpy.typing import NDArray

Float = NDArray[np.float64]
Stage = Callable[[Float, Float, Float], Float]
DriveStage = Callable[[Float, Float], Float]


@njit(cache=True)
def _play(values, half, held, out):  # type: ignore[no-untyped-def]
    for i in range(values.size):
        held = min(max(held, values[i] - half), values[i] + half)
        out[i] = held
    return held


@njit(cache=True)
def _pole(values, decay, now, before, last, state, out):  # type: ignore[no-untyped-def]
    for i in range(values.size):
        state = decay * state + now * values[i] + before * last
        last = values[i]
        out[i] = state
    return state


class Play:
    """Backlash: the output rests until the input has crossed the gap (the whole width), then is carried along."""

    def __init__(self, width: float, start: float = 0.0) -> None:
        self.half, self.held = 0.5 * width, 0.5 * width * start

    def __call__(self, time: Float, signal: Float, truth: Float) -> Float:
        out = np.empty_like(signal)
        self.held = _play(signal, self.half, self.held, out)
        return out


class Pole:
    """gain/(p - pole) of a signal, real part; exact for a signal that is linear between grid points."""

    def __init__(self, pole: complex, gain: complex) -> None:
        self.pole, self.gain = pole, gain
        self.state: complex | None = None
        self.last = 0.0

    def __call__(self, time: Float, signal: Float, truth: Float) -> Float:
        if self.state is None:
            self.state, self.last = -signal[0] / self.pole, float(signal[0])
        out = np.empty(signal.size, dtype=np.complex128)
        decay, now, before = self._weights(float(time[1] - time[0]) if len(time) > 1 else 5e-5)
        self.state = _pole(signal, decay, now, before, self.last, complex(self.state), out)
        self.last = float(signal[-1])
        response: Float = (self.gain * out).real
        return response

    def _weights(self, dt: float) -> tuple[complex, complex, complex]:
        z = self.pole * dt
        decay = cmath.exp(z)
        now = ((decay - 1.0) / z - 1.0) / self.pole
        return decay, now, (decay - (decay - 1.0) / z) / self.pole


def lag(time_constant: float) -> Pole:
    """First-order lag of unit gain."""
    return Pole(complex(-1.0 / time_constant), complex(1.0 / time_constant))


def resonance(frequency: float, damping_ratio: float) -> Pole:
    """Second-order response of unit static gain, damping_ratio below 1."""
    omega = 2.0 * math.pi * frequency
    damped = omega * math.sqrt(1.0 - damping_ratio**2)
    return Pole(complex(-damping_ratio * omega, damped), omega**2 / (1j * damped))


class Delay:
    """Every column of a signal, late by a time that need not be whole grid steps."""

    def __init__(self, delay: float) -> None:
        self.delay = delay
        self.time: Float = np.empty(0)
        self.past: Float = np.empty(0)

    def __call__(self, time: Float, signal: Float, truth: Float | None = None) -> Float:
        if not self.time.size:
            self.time, self.past = np.array([time[0] - self.delay - 1.0]), signal[:1]
        self.time, self.past = np.concatenate([self.time, time]), np.concatenate([self.past, signal])
        then = time - self.delay
        columns = self.past.reshape(len(self.past), -1).T
        out = np.stack([np.interp(then, self.time, column) for column in columns], axis=-1).reshape(signal.shape)
        keep = max(0, int(np.searchsorted(self.time, then[-1])) - 2)
        self.time, self.past = self.time[keep:], self.past[keep:]
        return out


class Inertia:
    """A mass that moves with the drive between it and the gauge's spring: signal + mass x''."""

    def __init__(self, mass: float) -> None:
        self.mass, self.speed = mass, 0.0

    def __call__(self, time: Float, signal: Float, truth: Float) -> Float:
        speeds = np.concatenate([[self.speed], truth[:, 1]])
        self.speed = float(speeds[-1])
        acceleration = np.diff(speeds) / (time[1] - time[0] if len(time) > 1 else 5e-5)
        return signal + self.mass * acceleration


class Screw:
    """A drive's path that is periodically off: x + amplitude (sin(k x + phase) - sin(phase))."""

    def __init__(self, amplitude: float, k: float, phase: float) -> None:
        self.amplitude, self.k, self.phase = amplitude, k, phase

    def __call__(self, time: Float, path: Float) -> Float:
        x, v = path[:, 0], path[:, 1]
        off = self.amplitude * (np.sin(self.k * x + self.phase) - math.sin(self.phase))
        rate = 1.0 + self.amplitude * self.k * np.cos(self.k * x + self.phase)
        return np.stack([x + off, v * rate], axis=-1)
