"""Lines of the mains: found where the stand is at rest, and taken out of the signal before anything else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stand.recording import Recording
from twin.diagnosis.smooth import noise

Float = NDArray[np.float64]
LOWEST, HIGHEST = 35.0, 420.0
SURE = 45.0
REST = 0.9
#: how much wider a channel may range in the last rest than in the first: a weight that still swings drowns a line
CALM = 2.0
#: reach and step, Hz, of each closer look: both rests together know a line to a small part of 1/their distance
ZOOM = (0.8, 0.01), (0.012, 0.0004)
SIGNALS = ("fibre_force", "weight_position", "drive_position")


@dataclass(frozen=True)
class Hum:
    """A line in one signal: frequency Hz, amplitude and its one sigma in the signal's SI unit, amplitude over noise."""

    signal: str
    frequency: float
    frequency_std: float
    amplitude: float
    amplitude_std: float
    strength: float


def find(recordings: Sequence[Recording]) -> tuple[list[Recording], list[Hum]]:
    """The recordings without their lines, and the lines: each stands at rest in one signal of every run."""
    if not all(_rests(r) for r in recordings):
        return list(recordings), []
    signals = [s for s in SIGNALS if all(s in r.channels for r in recordings)]
    grid = _grid(recordings)
    power = _powers(recordings, signals, grid)
    found = [h for s in signals if (h := _line(recordings, s, grid, power[s])) is not None]
    alone = [h for h in found if not any(_answers(h, other) for other in found)]
    cleaned = list(recordings)
    for line in alone:
        cleaned = [_without(r, line) for r in cleaned]
    return cleaned, alone


def _grid(recordings: Sequence[Recording]) -> Float:
    """Frequencies that are looked at, Hz: below what the slowest recording can tell."""
    return np.arange(LOWEST, max(min(HIGHEST, *(0.45 / r.dt for r in recordings)), LOWEST + 1.0), 0.5)


def _rests(recording: Recording) -> bool:
    """Whether it begins with a rest, and is fast enough to tell a hum from motion."""
    count = round(REST / recording.dt)
    still = all(np.ptp(v[:count]) < 1e-3 for n, v in recording.channels.items() if n.endswith("_position"))
    return still and 0.45 / recording.dt > 2 * LOWEST


def _answers(line: Hum, other: Hum) -> bool:
    """Two signals that sing alike: the stand itself vibrates, which is no wiring's fault."""
    return other is not line and abs(other.frequency - line.frequency) < 0.3


def _rest(recording: Recording, tail: bool = True) -> NDArray[np.bool_]:
    """The rest at both ends, or the one before any motion alone, also where the stand has not come to rest again."""
    n, count = len(recording.time), round(REST / recording.dt)
    mask = np.zeros(n, bool)
    mask[:count] = True
    if not tail:
        return mask
    last = count // 2
    if all(np.ptp(v[-last:]) < CALM * np.ptp(v[:count]) for v in recording.channels.values()):
        mask[-last:] = True
    return mask


def _line(recordings: Sequence[Recording], signal: str, grid: Float, powers: Sequence[Float]) -> Hum | None:
    sigma = [noise(r.channels[signal]) for r in recordings]
    power = np.zeros(len(grid))
    for own, s in zip(powers, sigma, strict=True):
        power += own / max(s, 1e-12) ** 2 / len(recordings)
    if power.max() < SURE / len(recordings) + 8.0 or np.sum(power > 0.3 * power.max()) > 9:
        return None
    frequency = float(grid[int(np.argmax(power))])
    for reach, step in ZOOM:
        fine = np.arange(frequency - reach, frequency + reach, step)
        near = _powers(recordings, [signal], fine)[signal]
        total = np.sum([own / s**2 for own, s in zip(near, sigma, strict=True)], axis=0)
        frequency = float(fine[int(np.argmax(total))])
    amplitudes = [float(np.hypot(*_amplitude(r, signal, frequency))) for r in recordings]
    amplitude, count = float(np.median(amplitudes)), float(np.mean([_rest(r).sum() for r in recordings]))
    s = float(np.median(sigma))
    std = s * np.sqrt(2.0 / count / len(recordings))
    if amplitude < 0.12 * s or min(amplitudes) < 0.4 * amplitude:
        return None
    before = [float(np.hypot(*_amplitude(r, signal, frequency, tail=False))) for r in recordings]
    if float(np.median(before)) < 0.6 * amplitude:  # what rings after the motion is the stand's own
        return None
    spread = 0.35 * s / max(amplitude, 1e-12) / np.sqrt(count * len(recordings))
    return Hum(signal, frequency, float(spread), amplitude, float(std), amplitude / s / np.sqrt(2.0))


def _powers(recordings: Sequence[Recording], signals: Sequence[str], frequencies: Float) -> dict[str, list[Float]]:
    """|sum of signal e^-iwt|^2 / n of each signal over each run's rest, each end without its trend."""
    found: dict[str, list[Float]] = {s: [] for s in signals}
    known: dict[bytes, Float] = {}
    for recording in recordings:
        mask = _rest(recording)
        time = recording.time[mask] - recording.time[0]
        key = np.round(time, 9).tobytes()
        if key not in known:
            angle = -2 * np.pi * np.outer(frequencies, time)
            known = {key: np.stack([np.cos(angle), np.sin(angle)])}
        values = np.column_stack([_level(recording.channels[s], mask) for s in signals])
        power = np.sum((known[key] @ values) ** 2, axis=0) / len(values)
        for k, signal in enumerate(signals):
            found[signal].append(power[:, k])
    return found


def _level(values: Float, mask: NDArray[np.bool_]) -> Float:
    """The rest's samples, each stretch without its own straight line."""
    parts = np.split(np.flatnonzero(mask), np.flatnonzero(np.diff(np.flatnonzero(mask)) > 1) + 1)
    out = []
    for part in parts:
        at = np.linspace(-1, 1, len(part))
        out.append(values[part] - np.polyval(np.polyfit(at, values[part], 1), at))
    return np.concatenate(out)


def _amplitude(recording: Recording, signal: str, frequency: float, tail: bool = True) -> tuple[float, float]:
    mask = _rest(recording, tail)
    omega, time = 2 * np.pi * frequency, recording.time[mask]
    basis = np.column_stack([np.cos(omega * time), np.sin(omega * time)])
    a, b = np.linalg.lstsq(basis, _level(recording.channels[signal], mask), rcond=None)[0]
    return float(a), float(b)


def _without(recording: Recording, line: Hum) -> Recording:
    a, b = _amplitude(recording, line.signal, line.frequency)
    omega, time = 2 * np.pi * line.frequency, recording.time
    clean: Mapping[str, Float] = {
        **recording.channels,
        line.signal: recording.channels[line.signal] - a * np.cos(omega * time) - b * np.sin(omega * time),
    }
    return replace(recording, channels=clean)
