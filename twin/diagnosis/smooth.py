"""Smoothing without a choice by hand, and the noise of a channel from the channel itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.floating[Any]]
_DIFFERENCE = np.array([1.0, -4.0, 6.0, -4.0, 1.0])
_CUTOFFS = np.array([12.0, 18.0, 27.0, 40.0, 60.0, 85.0, 120.0, 170.0, 240.0, 340.0, 480.0, 650.0])


@dataclass(frozen=True)
class Smooth:
    """A channel with its rates and what smoothing left: value, rate, second [n]; error: one sigma of value."""

    value: Float
    rate: Float
    second: Float
    cutoff: float
    error: float


def noise(values: Float) -> float:
    """One sigma of a channel's white noise: fourth differences (blind to motion), by their median (blind to
    impacts).
    """
    spread = np.abs(np.convolve(values, _DIFFERENCE, "valid"))
    middle = float(np.median(spread))
    if middle == 0.0:
        return float(np.std(np.convolve(values, _DIFFERENCE, "valid")) / np.sqrt(70.0))
    return middle / 0.6745 / float(np.sqrt(70.0))


def smooth(values: Float, dt: float, sigma: float, cutoff: float | None = None) -> Smooth:
    """`values` without noise of `sigma`: a zero-phase low-pass whose cut-off minimises Stein's unbiased risk."""
    n = len(values)
    pad = min(n - 1, round(0.3 / dt))
    padded = np.concatenate([2 * values[0] - values[pad:0:-1], values, 2 * values[-1] - values[-2 : -pad - 2 : -1]])
    slope = np.linspace(padded[:20].mean(), padded[-20:].mean(), n + 2 * pad)
    spectrum = np.fft.rfft(padded - slope)
    omega = 2 * np.pi * np.fft.rfftfreq(len(padded), dt)
    cutoff = cutoff or _best(spectrum, omega, dt, sigma, len(padded))
    passed = _response(omega, cutoff) * spectrum
    tilt = (slope[-1] - slope[0]) / (len(slope) - 1) / dt
    parts = [np.fft.irfft(passed * (1j * omega) ** k, len(padded))[pad : pad + n] for k in range(3)]
    kept = float(np.mean(_response(omega, cutoff) ** 2))
    return Smooth(parts[0] + slope[pad : pad + n], parts[1] + tilt, parts[2], cutoff, sigma * float(np.sqrt(kept)))


def _response(omega: Float, cutoff: float) -> Float:
    response: Float = 1.0 / (1.0 + (omega / (2 * np.pi * cutoff)) ** 6)
    return response


def _best(spectrum: NDArray[np.complexfloating[Any, Any]], omega: Float, dt: float, sigma: float, n: int) -> float:
    """Stein's risk in the frequency domain: power left out, and twice the noise let through."""
    power = np.abs(spectrum) ** 2 * 2 / n
    cutoffs = _CUTOFFS[0.4 / dt > _CUTOFFS]
    risks = []
    for cutoff in cutoffs:
        response = _response(omega, float(cutoff))
        risks.append(float(np.sum((1 - response) ** 2 * power) + 2 * sigma**2 * np.sum(response) * 2))
    return float(cutoffs[int(np.argmin(risks))])


def polynomial(
    values: Float, places: NDArray[np.int64], half: int, degree: int, dt: float
) -> tuple[Float, Float, Float]:
    """Local least-squares polynomials: value, rate [k] at `places`, and the rms of what each leaves."""
    local = np.arange(-half, half + 1) * dt
    basis = np.vander(local / (half * dt), degree + 1, increasing=True)
    solve = np.linalg.pinv(basis)
    samples = values[places[:, None] + np.arange(-half, half + 1)]
    coefficients = samples @ solve.T
    left = samples - coefficients @ basis.T
    spread = np.sqrt(np.sum(left**2, axis=1) / (2 * half - degree))
    return coefficients[:, 0], coefficients[:, 1] / (half * dt), spread


def curvature(values: Float, places: NDArray[np.int64], half: int, dt: float) -> Float:
    """Second derivative [k] at `places` by local cubics."""
    basis = np.vander(np.arange(-half, half + 1) / half, 4, increasing=True)
    samples = values[places[:, None] + np.arange(-half, half + 1)]
    second: Float = 2.0 * samples @ np.linalg.pinv(basis)[2] / (half * dt) ** 2
    return second


def gains(half: int, degree: int, dt: float) -> tuple[float, float]:
    """How much of a sample's noise a local polynomial's value and rate (1/s) have."""
    basis = np.vander(np.arange(-half, half + 1) / half, degree + 1, increasing=True)
    solve = np.linalg.pinv(basis)
    return float(np.linalg.norm(solve[0])), float(np.linalg.norm(solve[1]) / (half * dt))


def ahead(here: tuple[Float, Float, Float], time: Float) -> tuple[Float, Float, Float]:
    """Value, rate and second derivative `time` s further on."""
    value, rate, second = here
    return value + time * rate + 0.5 * time**2 * second, rate + time * second, second
