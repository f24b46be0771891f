"""From samples at even times to the grid: band-limited interpolation that adds no bias, and x smoothed to its noise."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Bool = NDArray[np.bool_]

TAPS = 24
_BETA = 7.0
_FINE = 1024


def interpolate(values: Float, position: Float) -> Float:
    """Values at fractional indices: a Kaiser-windowed sinc of 24 taps, flat to 0.75 of the Nyquist frequency.

    values: [n], even; position: [m] in samples, held at the ends. The ends are continued oddly, so that a slope passes.
    """
    half = TAPS // 2
    padded = _continued(values, half)
    position = np.clip(position, 0.0, len(values) - 1.0)
    whole = np.floor(position).astype(np.int64)
    table = _kernel()
    place = (position - whole) * _FINE
    row = np.minimum(place.astype(np.int64), _FINE - 1)
    share = (place - row)[:, None]
    weights = table[row] * (1 - share) + table[row + 1] * share
    windows = np.lib.stride_tricks.sliding_window_view(padded, TAPS)
    out: Float = np.einsum("ij,ij->i", windows[whole + 1], weights)
    return out


@cache
def _kernel() -> Float:
    """Weights [1025, 24] for shares of a sample from 0 to 1; linear between rows is good to 2e-6."""
    half = TAPS // 2
    distance = np.linspace(0, 1, _FINE + 1)[:, None] - np.arange(-half + 1, half + 1)[None, :]
    weights = np.sinc(distance) * np.i0(_BETA * np.sqrt(np.clip(1 - (distance / half) ** 2, 0.0, 1.0)))
    normed: Float = weights / weights.sum(axis=1, keepdims=True)
    return normed


def _continued(values: Float, count: int) -> Float:
    count_low = min(count, len(values) - 1)
    low = 2 * values[0] - values[count_low:0:-1] if count_low else values[:0]
    high = 2 * values[-1] - values[-2 : -2 - count_low : -1] if count_low else values[:0]
    low = np.concatenate((np.full(count - count_low, low[0] if count_low else values[0]), low))
    high = np.concatenate((high, np.full(count - count_low + 1, high[-1] if count_low else values[-1])))
    return np.concatenate((low, values, high))


def fill(index: NDArray[np.int64], values: Float, good: Bool) -> tuple[Float, Bool]:
    """Samples by true index made even: [n] from the first index to the last, and which of them were measured.

    What is missing is bridged by a cubic that meets the samples on either side with their slopes (Hermite).
    """
    index, values = index[good], values[good]
    count = int(index[-1] - index[0]) + 1
    out, there = np.empty(count), np.zeros(count, dtype=np.bool_)
    there[index - index[0]] = True
    out[index - index[0]] = values
    edges = np.flatnonzero(np.diff(index) > 1)
    for left in edges.tolist():
        _bridge(out, index, values, left)
    return out, there


def _bridge(out: Float, index: NDArray[np.int64], values: Float, left: int) -> None:
    a, b = int(index[left]), int(index[left + 1])
    span = b - a
    before = (
        values[left] - values[left - 1]
        if left and index[left - 1] == a - 1
        else (values[left + 1] - values[left]) / span
    )
    more = left + 2 < len(index) and index[left + 2] == b + 1
    after = values[left + 2] - values[left + 1] if more else (values[left + 1] - values[left]) / span
    s = np.arange(1, span) / span
    basis = (2 * s**3 - 3 * s**2 + 1, s**3 - 2 * s**2 + s, -2 * s**3 + 3 * s**2, s**3 - s**2)
    bridge = basis[0] * values[left] + basis[2] * values[left + 1]
    out[a + 1 - index[0] : b - index[0]] = bridge + span * (basis[1] * before + basis[3] * after)


def noise_of(values: Float) -> float:
    """One sigma of white noise on a smooth series: from fourth differences, by their median (robust to motion)."""
    if len(values) < 20:
        return 0.0
    fourth = np.diff(values, 4)
    return float(np.median(np.abs(fourth)) / 0.6744897501960817 / np.sqrt(70.0))


def smooth(values: Float, dt: float) -> tuple[Float, float]:
    """A smoothing spline of order 3 at the cutoff of least generalised cross-validation, and its one sigma.

    H = 1 / (1 + (f / f_c)^6) minimises sum (y - z)^2 + (2 pi f_c)^-6 int z'''^2 (Craven, Wahba 1979), done by Fourier
    transform on the series continued evenly about its ends' trend. Where no cutoff below Nyquist beats leaving the
    series alone, it is left alone.
    """
    n = len(values)
    if n < 64:
        return values, noise_of(values)
    trend = np.linspace(values[0], values[-1], n)
    rest = values - trend
    spectrum = np.fft.rfft(np.concatenate((rest, -rest[-2:0:-1])))
    frequency = np.fft.rfftfreq(2 * n - 2, dt)
    power, free = np.abs(spectrum) ** 2, len(spectrum)
    best: tuple[float, Float] | None = None
    for cutoff in np.geomspace(30.0, 0.45 / dt, 40):
        gain = 1 / (1 + (frequency / cutoff) ** 6)
        score = float(np.sum((1 - gain) ** 2 * power) / (1 - gain.sum() / free) ** 2)
        if best is None or score < best[0]:
            best = (score, gain)
    assert best is not None
    score, gain = best
    share = float(gain.sum() / free)
    noise = np.sqrt(np.sum((1 - gain) ** 2 * power) / free / (2 * n - 2) / max(1 - share, 1e-9))
    smoothed: Float = np.fft.irfft(spectrum * gain, 2 * n - 2)[:n] + trend
    return smoothed, float(noise * np.sqrt(share))
