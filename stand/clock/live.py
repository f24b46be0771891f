"""The same grid while the run goes on: clocks fitted anew, samples handed on once all three channels are there."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.block import Block
from stand.clock.align import REST
from stand.clock.lines import line_below
from stand.clock.model import RATE, Float, LiveBlock
from stand.clock.ring import fit_ring
from stand.config import DriveConfig, GaugeConfig, Stand
from stand.drive.profile import load_profile
from stand.recording.model import Quality

KEEP = 6000
REFIT, RECENT, HISTORY = 0.25, 1.0, 20.0
THIN, POLLS = 0.02, 2.5
_ORDER = ("drive", "dial_gauge", "force_gauge")
_BITS = (Quality.DRIVE_POSITION, Quality.WEIGHT_POSITION, Quality.FIBRE_FORCE)


@dataclass
class _Channel:
    """One instrument as it streams: its last samples by index, and sample k's time offset + k * period."""

    config: DriveConfig | GaugeConfig
    period: float
    values: Float
    flags: NDArray[np.uint8]
    next: int = 0
    nominal: float = 0.0
    offset: float | None = None
    fitted: float = -np.inf
    newest: float = -np.inf

    def __post_init__(self) -> None:
        self.nominal = self.period
        self.reads: deque[tuple[float, float, float]] = deque()

    def push(self, block: Block) -> None:
        """Take a block's samples and times in."""
        first = block.first
        if first > self.next and len(self.values):
            missing = min(first - self.next, KEEP)
            self.values = np.concatenate((self.values, np.full(missing, self.values[-1])))
            self.flags = np.concatenate((self.flags, np.full(missing, 2, np.uint8)))
        self.values = np.concatenate((self.values, block.values))[-KEEP:]
        self.flags = np.concatenate((self.flags, block.flags))[-KEEP:]
        self.next, self.newest = first + len(block), block.arrival
        self._remember((float(self.next), block.arrival, block.request or block.arrival))
        wait = REFIT if self.offset is None or not isinstance(self.config, DriveConfig) else 4 * REFIT
        if block.arrival > self.fitted + wait and len(self.reads) >= 10:
            self.fitted = block.arrival
            self._fit()

    def _remember(self, read: tuple[float, float, float]) -> None:
        """Polls as they are; of a gauge's reads the promptest in each short while, so that a fit costs little."""
        drive = isinstance(self.config, DriveConfig)
        last = self.reads[-1] if self.reads else None
        if drive or last is None or int(read[1] / THIN) != int(last[1] / THIN):
            self.reads.append(read)
        elif read[1] - self.nominal * read[0] < last[1] - self.nominal * last[0]:
            self.reads[-1] = read
        while self.reads[0][1] < read[1] - (POLLS if drive else HISTORY):
            self.reads.popleft()

    def _fit(self) -> None:
        count, arrival, request = (np.array(part) for part in zip(*self.reads, strict=True))
        if isinstance(self.config, DriveConfig):
            clock = fit_ring(count, request, arrival, self.nominal, self.config.latency, 0.0)
            self.offset, self.period = clock.offset, clock.period
            return
        if arrival[-1] - arrival[0] > 2.0:
            slope = line_below(count, arrival, self.nominal).slope
            self.period = float(np.clip(slope, self.nominal * (1 - 3e-4), self.nominal * (1 + 3e-4)))
        recent = arrival > arrival[-1] - RECENT
        earliest = float(np.min(arrival[recent] - self.period * (count[recent] - 1)))
        self.offset = earliest - self.config.latency

    def known_until(self) -> float:
        """Host time up to which the channel can be interpolated, s."""
        return -np.inf if self.offset is None else self.offset + self.period * (self.next - 3)

    def known_from(self) -> float:
        """Host time from which it can, s."""
        return np.inf if self.offset is None else self.offset + self.period * (self.next - len(self.values) + 1)

    def at(self, time: Float) -> tuple[Float, NDArray[np.uint8]]:
        """Values by cubic interpolation, and the flags of the nearest samples."""
        assert self.offset is not None, "asked only once fitted"
        place = (time - self.offset) / self.period - (self.next - len(self.values))
        whole = np.clip(np.floor(place).astype(np.int64), 1, len(self.values) - 3)
        s = place - whole
        a, b, c, d = (self.values[whole + k] for k in (-1, 0, 1, 2))
        cubic = b + s * ((c - a / 3 - b / 2 - d / 6) + s * ((a + c) / 2 - b + s * ((b - c) / 2 + (d - a) / 6)))
        nearest = np.clip(np.round(place).astype(np.int64), 0, len(self.values) - 1)
        return cubic, self.flags[nearest]


def nominal_rate(config: DriveConfig | GaugeConfig) -> float:
    """Samples that the instrument takes in a second by its own clock, Hz: a drive's ring has one of its own."""
    if isinstance(config, DriveConfig):
        trace = load_profile(config.profile).trace
        return float(trace.clock_hz if trace.kind == "ring" else config.rate)
    return float(config.rate)


class LiveAligner:
    """Blocks in, grid samples out. One for each run; not for several threads at once.

    Nothing comes out before 0.4 s of the grid are known: x and u are relative to that rest, as in the file.
    """

    def __init__(self, stand: Stand, origin: float) -> None:
        self.origin, self.next = origin, 0
        self._channels: dict[str, _Channel] = {}
        for name, config in stand.instruments.items():
            rate = nominal_rate(config)
            self._channels[name] = _Channel(config, 1 / rate, np.empty(0), np.empty(0, np.uint8))
        self._scale = {n: c.scale for n, c in stand.instruments.items() if isinstance(c, GaugeConfig)}
        self._zeros: tuple[float, float] | None = None

    def push(self, block: Block) -> LiveBlock | None:
        """The grid samples that this block completes, if any."""
        channel = self._channels.get(block.instrument)
        if channel is None or not len(block):
            return None
        channel.push(block)
        until = min(c.known_until() for c in self._channels.values())
        if not np.isfinite(until):
            return None
        end = int(np.floor((until - self.origin) * RATE)) + 1
        least = round(REST * RATE) if self._zeros is None else 4
        if end - self.next < least:
            return None
        return self._emit(end)

    def _emit(self, end: int) -> LiveBlock | None:
        begin = max(self.next, end - KEEP // 2)
        time = np.arange(begin, end) / RATE
        (x, fx), (u, fu), (force, ff) = (self._channels[name].at(self.origin + time) for name in _ORDER)
        u, force = u * self._scale["dial_gauge"], force * self._scale["force_gauge"]
        if self._zeros is None:
            rest = slice(0, round(REST * RATE))
            self._zeros = (float(np.median(x[rest])), float(np.median(u[rest])))
        quality = np.zeros(len(time), np.uint8)
        for bit, flags in zip(_BITS, (fx, fu, ff), strict=True):
            quality |= np.where(flags & 2, np.uint8(bit), np.uint8(0))
            quality |= np.where(flags & 1, np.uint8(Quality.FAULT), np.uint8(0))
        self.next = end
        newest = max(channel.newest for channel in self._channels.values())
        return LiveBlock(begin, time, x - self._zeros[0], u - self._zeros[1], force, quality, newest)
