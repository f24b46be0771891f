"""A gauge that cannot tell more than a level: seen in the record itself, where flat tops begin and end abruptly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stand.setup import System
from twin.diagnosis.run import Run

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]
BAND = 5.0  # sigmas about a level that count as flat
ABOVE = 9.0  # sigmas above it that no sample reaches
ABRUPT = 1.6  # times what a parabola as long as the flat would have dropped a little beyond it
#: channel: cause, samples a flat lasts at least, samples beyond it that are looked at, sigmas dropped there
CHANNELS = (("dial-gauge-saturation", 16, 6, 40.0), ("force-gauge-saturation", 6, 4, 30.0))


@dataclass(frozen=True)
class Clip:
    """A limit: the cause's name, its level and one sigma of it (m or N), how many flats show it, and how
    far beyond the noise their ends fall off."""

    cause: str
    level: float
    std: float
    flats: int
    strength: float


def find(runs: Sequence[Run]) -> tuple[tuple[Run, ...], list[Clip]]:
    """The runs with what lies at a limit marked as not to be used, and the limits.

    A fibre only pulls, so a weight at the top of its way leaves it at g sin(alpha) and friction at most, and a force's
    peak rings through: a flat with steep ends at one and the same highest level is the gauge's.
    """
    if runs[0].setup.system is not System.WFPD:
        return tuple(runs), []
    found: list[Clip] = []
    masks = [r.bad.copy() for r in runs]
    for channel, (cause, least, beyond, drop) in enumerate(CHANNELS):
        signals = [r.raw_u if channel == 0 else r.raw_F for r in runs]
        sigma = float(np.median([r.noise_u if channel == 0 else r.noise_F for r in runs]))
        level = _highest(signals, sigma)
        flats = [_flats(s, level, sigma, least, beyond, drop) for s in signals]
        count = sum(map(len, flats))
        if count < 2:
            continue
        inside = np.concatenate([s[a:b] for s, own in zip(signals, flats, strict=True) for a, b in own])
        found.append(Clip(cause, float(inside.mean()), sigma / float(np.sqrt(len(inside))), count, drop))
        for signal, mask in zip(signals, masks, strict=True):
            mask[:, channel] |= np.convolve(signal > level - BAND * sigma, np.ones(5), "same") > 0
    return tuple(replace(r, bad=m) for r, m in zip(runs, masks, strict=True)), found


def _highest(signals: Sequence[Float], sigma: float) -> float:
    """The level just below the highest sample: where a limit is, the middle of what lies there."""
    top = max(float(s.max()) for s in signals)
    near = np.concatenate([s[s > top - 1.6 * BAND * sigma] for s in signals])
    return float(np.median(near))


def _flats(signal: Float, level: float, sigma: float, least: int, beyond: int, drop: float) -> list[tuple[int, int]]:
    """Where a signal stands at the level and falls off abruptly on both sides: [first, last)."""
    if signal.max() > level + ABOVE * sigma:
        return []
    edges = np.flatnonzero(np.diff(np.concatenate([[0], (signal > level - BAND * sigma).astype(int), [0]])))
    told = []
    for a, b in zip(edges[::2], edges[1::2], strict=True):
        if b - a < least or a < beyond or b + beyond > len(signal):
            continue
        half = (b - a) / 2
        needed = max(drop, ABRUPT * 2 * BAND * ((half + beyond) / half) ** 2) * sigma
        if min(level - signal[a - beyond], level - signal[b + beyond - 1]) > needed:
            told.append((int(a), int(b)))
    return told
