"""Quasi-sinusoidal: (1 - cos) from rest to rest, its first and last corner rounded by a moving average."""

from __future__ import annotations

import math

import numpy as np

from stand.config import Limits
from stand.excitation.curve import Curve, Float, Peaks, Waveform
from stand.excitation.spec import Excitation, Shape

ROUNDING = 0.05


def build(excitation: Excitation, limits: Limits) -> Curve:
    """x = A/2 (1 - cos 2 pi f t) averaged over 5 % of a cycle and scaled so that its swing is the stroke."""
    omega, window = 2 * math.pi * excitation.frequency, ROUNDING / excitation.frequency
    length = round(excitation.cycles) / excitation.frequency
    loss = math.sin(omega * window / 2) / (omega * window / 2)
    half = excitation.amplitude / 2 / loss

    def integral(t: Float) -> Float:
        """x integrated, x, x', x'' of the plain (1 - cos), at rest outside [0, length]."""
        inside = (t > 0) & (t < length)
        held = np.clip(t, 0.0, length)
        c, s = np.cos(omega * held), np.sin(omega * held)
        return half * np.stack((held - s / omega, 1 - c, omega * s, omega**2 * c * inside))

    def evaluate(t: Float) -> Float:
        out: Float = (integral(t) - integral(t - window)) / window
        return out

    peak = excitation.amplitude / 2
    low = half - peak
    jerk = max(half * omega**2 / window, peak * omega**3)
    peaks = Peaks(peak * omega, half * omega**2, jerk)
    return Curve(length + window, peaks, (0.0, low + excitation.amplitude), evaluate)


WAVEFORM = Waveform(Shape.QUASI_SINUSOIDAL, "quasi-sinusoidal", "Polach et al., S0, S1: shape; ends assumed", build)
