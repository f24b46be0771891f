"""Plain polling, for drives without a counted ring: position and velocity at the middle of each poll's bracket.

Between polls a cubic meets both (Hermite); its error is at most dt^4 / 384 |x''''| for exact samples; timing usually
weighs more: speed times the bracket's half. Such a channel is labelled derived; nothing in it is a counted sample.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stand.clock.model import Float, RingStream

#: registers of a poll as stored: position and velocity in the drive's counts, 32 bit, high word first
WORDS = 4


def pack_poll(position: int, velocity: int) -> NDArray[np.uint16]:
    """A poll's counts as uint16 [4]."""
    return np.array([position, velocity], dtype=">i4").view(">u2").astype(np.uint16)


def unpack_polls(registers: NDArray[np.uint16]) -> tuple[Float, Float]:
    """Positions and velocities in counts, float64 [k] each."""
    counts = np.ascontiguousarray(registers[:, :WORDS]).astype(">u2").view(">i4").astype(np.float64)
    return counts[:, 0], counts[:, 1]


def hermite(time: Float, value: Float, rate: Float, at: Float) -> Float:
    """The piecewise cubic through values and rates [k] at ascending times, at times [n]; held beyond the ends."""
    left = np.clip(np.searchsorted(time, at, "right") - 1, 0, len(time) - 2)
    span = time[left + 1] - time[left]
    s = np.clip((at - time[left]) / span, 0.0, 1.0)
    low = (2 * s**3 - 3 * s**2 + 1) * value[left] + (s**3 - 2 * s**2 + s) * span * rate[left]
    high = (3 * s**2 - 2 * s**3) * value[left + 1] + (s**3 - s**2) * span * rate[left + 1]
    out: Float = low + high
    return out


def polls_on_grid(
    stream: RingStream, position_scale: float, velocity_scale: float, latency: float, grid: Float, widest: float
) -> tuple[Float, float, NDArray[np.bool_]]:
    """x on the grid m [n], one sigma, and where polls stand farther apart than `widest` s."""
    position, velocity = unpack_polls(stream.registers)
    time = (stream.request_time + stream.response_time) / 2 - latency
    x = hermite(time, position * position_scale, velocity * velocity_scale, grid)
    half = (stream.response_time - stream.request_time) / np.sqrt(12)
    sigma = float(np.sqrt(np.mean((velocity * velocity_scale * half) ** 2) + position_scale**2 / 12))
    right = np.clip(np.searchsorted(time, grid), 1, len(time) - 1)
    far = (time[right] - time[right - 1] > widest) | (grid < time[0]) | (grid > time[-1])
    return x, sigma, far
