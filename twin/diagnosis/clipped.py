"""A gauge that cannot tell more than a level: seen in the record itself, where flat tops begin and end abruptly."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stand.setup import System
from twin.diagnosis.run import Run

Float = NDArray[np.float64]
BAND = 5.0  # sigmas about a level that count as flat
ABOVE = 9.0  # sigmas above it that no sample reaches
ABRUPT = 1.6  # times what a parabola as long as the flat would have dropped a little beyond it
GUIDE_END = 0.25  # m from rest, where the guide of the stand ends by its drawing: no deviation
ONSET = 0.0025  # s from the touch until the speed has fallen enough to be seen
BRAKED, RISING = 0.12, 0.1  # m/s lost beyond weight and friction, of at least this speed upwards
SURE = 7e-4  # m, one sigma at best of a stop that is read off the speed
NEAR, PASSED = 2e-3, 8e-3  # m about a stop that count as it, and that a weight may press into it
#: channel: cause, samples a flat lasts at least, samples beyond it that are looked at, sigmas dropped there
CHANNELS = (("dial-gauge-saturation", 16, 6, 40.0), ("force-gauge-saturation", 6, 4, 30.0))


@dataclass(frozen=True)
class Clip:
    """A limit: the cause's name, its level and one sigma of it (m or N), how many flats (or brakings) show it, and by
    how many sigmas of the noise, of the median one, the signal falls off there (the speed is lost).
    """

    cause: str
    level: float
    std: float
    flats: int
    strength: float


def find(runs: Sequence[Run], considered: Collection[str]) -> tuple[tuple[Run, ...], list[Clip]]:
    """The runs with what lies at a limit marked as not to be used, and the limits; considered: names to look for.

    A fibre only pulls, so a weight at the top of its way leaves it at g sin(alpha) and friction at most, and a force's
    peak rings through: a flat with steep ends at one and the same highest level is the gauge's.
    """
    if runs[0].setup.system is not System.WFPD:
        return tuple(runs), []
    found: list[Clip] = []
    masks = [r.bad.copy() for r in runs]
    for channel, (cause, least, beyond, drop) in enumerate(CHANNELS):
        if cause not in considered:
            continue
        signals = [r.raw_u if channel == 0 else r.raw_F for r in runs]
        sigma = float(np.median([r.noise_u if channel == 0 else r.noise_F for r in runs]))
        level = _highest(signals, sigma)
        flats = [_flats(s, level, sigma, least, beyond, drop) for s in signals]
        falls = [fall for own in flats for _, _, fall in own]
        if len(falls) < 2:
            continue
        inside = np.concatenate([s[a:b] for s, own in zip(signals, flats, strict=True) for a, b, _ in own])
        std = sigma / float(np.sqrt(len(inside)))
        found.append(Clip(cause, float(inside.mean()), std, len(falls), float(np.median(falls))))
        for signal, mask in zip(signals, masks, strict=True):
            mask[:, channel] |= np.convolve(signal > level - BAND * sigma, np.ones(5), "same") > 0
    return tuple(replace(r, bad=m) for r, m in zip(runs, masks, strict=True)), found


def _highest(signals: Sequence[Float], sigma: float) -> float:
    """The level just below the highest sample: where a limit is, the middle of what lies there."""
    top = max(float(s.max()) for s in signals)
    near = np.concatenate([s[s > top - 1.6 * BAND * sigma] for s in signals])
    return float(np.median(near))


def _flats(
    signal: Float, level: float, sigma: float, least: int, beyond: int, drop: float
) -> list[tuple[int, int, float]]:
    """Where a signal stands at the level and falls off abruptly on both sides: [first, last), the fall in sigmas."""
    if signal.max() > level + ABOVE * sigma:
        return []
    edges = np.flatnonzero(np.diff(np.concatenate([[0], (signal > level - BAND * sigma).astype(int), [0]])))
    told = []
    for a, b in zip(edges[::2], edges[1::2], strict=True):
        if b - a < least or a < beyond or b + beyond > len(signal):
            continue
        half = (b - a) / 2
        fall = float(level - max(signal[a - beyond], signal[b + beyond - 1])) / sigma
        if fall > max(drop, ABRUPT * 2 * BAND * ((half + beyond) / half) ** 2):
            told.append((int(a), int(b), fall))
    return told


def stop(runs: Sequence[Run]) -> list[Clip]:
    """A stop in the guide, from the weight's own motion: a fibre can't push, so a weight that goes up and is braked far
    harder than by its weight and friction met something, each time at one place that it never passes by much.
    """
    if runs[0].setup.system is System.LINEAR_DRIVE:
        return []
    met = [pair for run in runs for pair in _braked(run)]
    if len(met) < 2:
        return []
    level = float(np.median([place for place, _ in met]))
    highest = max(float(run.u.value.max()) for run in runs)
    near = [place for place, _ in met if abs(place - level) < NEAR]
    if len(near) < max(2, 0.7 * len(met)) or highest > level + PASSED or level > GUIDE_END - PASSED:
        return []
    std = max(float(np.std(near)) / float(np.sqrt(len(near))), SURE)
    return [Clip("end-stop", level, std, len(near), float(np.median([lost for _, lost in met])))]


def _braked(run: Run) -> list[tuple[float, float]]:
    """u where a brake begins that neither weight nor friction can be, and the speed it takes beyond theirs, in sigmas
    of the speed.
    """
    half, gap = max(1, round(0.002 / run.dt)), max(1, round(0.006 / run.dt))
    span = 2 * half * run.dt
    v = (run.raw_u[2 * half :] - run.raw_u[: -2 * half]) / span  # v[i] at sample i + half
    usual = 2.0 * (run.setup.rest_tension + run.setup.guide_friction) / run.setup.mass
    lost = v[: -2 * gap] - v[2 * gap :] - usual * 2 * gap * run.dt  # over 2 gap, about sample i + half + gap
    hard = (lost > BRAKED) & (v[: -2 * gap] > RISING)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], hard.astype(int), [0]])))
    onset = half + 2 * gap - round(ONSET / run.dt)  # where it is first seen, the later speed has just begun to fall
    noise = 2.0 * run.noise_u / span
    return [
        (float(run.raw_u[a + onset]), float(lost[a:b].max()) / noise)
        for a, b in zip(edges[::2], edges[1::2], strict=True)
    ]
