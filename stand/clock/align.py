"""Raw streams -> fitted clocks -> one uniform 2 kHz grid. Pure: the same bytes and times give the same grid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.clock.arrivals import Reads
from stand.clock.gauge import GaugeFit, fit_gauge
from stand.clock.model import RATE, Aligned, Clock, Float, GaugeStream, Loss, RingStream, Streams
from stand.clock.polls import polls_on_grid
from stand.clock.resample import fill, interpolate, noise_of, smooth
from stand.clock.ring import fit_ring
from stand.codecs.codec import Frames, load_codec
from stand.config import DriveConfig, GaugeConfig, Stand
from stand.drive.profile import load_profile
from stand.errors import InputError
from stand.recording.model import Quality
from stand.transport.raw import RawRegisters
from stand.transport.ring import RingDecoder

REST = 0.4
CHANNELS = {"drive": "drive_position", "dial_gauge": "weight_position", "force_gauge": "fibre_force"}
_BITS = {"drive": Quality.DRIVE_POSITION, "dial_gauge": Quality.WEIGHT_POSITION, "force_gauge": Quality.FIBRE_FORCE}


@dataclass(frozen=True)
class Track:
    """One instrument's samples by true index: values SI [n], device's fault flags, valid (a measurement), clock."""

    index: NDArray[np.int64]
    values: Float
    flags: NDArray[np.uint8]
    valid: NDArray[np.bool_]
    clock: Clock
    losses: tuple[Loss, ...]
    counts: dict[str, int]


def align(streams: Streams, stand: Stand, origin: float, count: int, word_order: str | None = None) -> Aligned:
    """The run on `count` samples at origin + n / 2000 (host's monotonic clock, s).

    streams: "drive" -> RingStream, "force_gauge" and "dial_gauge" -> GaugeStream; any of them may be absent, as on a
    rig without a drive. word_order: what the drive's probe found, else the profile's. InputError where a stream is
    too short for a clock.
    """
    plain = [name for name, stream in streams.items() if isinstance(stream, RingStream) and _is_plain(stand)]
    tracks = {n: _track(n, stream, stand, word_order) for n, stream in streams.items() if n not in plain}
    grid = origin + np.arange(count) / RATE
    quality = np.zeros(count, np.uint8)
    channels: dict[str, Float] = {}
    uncertainty: dict[str, float] = {}
    zeros: dict[str, float] = {}
    for name, track in tracks.items():
        channel = CHANNELS[name]
        values, sigma, missing, fault = _on_grid(track, grid, name == "drive")
        quality[missing] |= np.uint8(_BITS[name])
        quality[fault] |= np.uint8(Quality.FAULT)
        zeros[channel] = float(np.median(values[: round(REST * RATE)])) if name != "force_gauge" else 0.0
        channels[channel] = values - zeros[channel]
        uncertainty[channel] = sigma
    for name in plain:
        channel, stream = CHANNELS[name], streams[name]
        assert isinstance(stream, RingStream)
        scale, speed_scale = _scales(stand)
        values, sigma, missing = polls_on_grid(
            stream, scale, speed_scale, stand.drive.latency, grid, 2.5 / stand.drive.poll_rate
        )
        quality[missing] |= np.uint8(_BITS[name])
        zeros[channel] = float(np.median(values[: round(REST * RATE)]))
        channels[channel], uncertainty[channel] = values - zeros[channel], sigma
    return Aligned(
        origin=origin,
        time=np.arange(count) / RATE,
        channels=channels,
        quality=quality,
        uncertainty=uncertainty,
        clocks={name: track.clock for name, track in tracks.items()},
        zeros=zeros,
        losses=tuple(loss for track in tracks.values() for loss in track.losses),
        counts={name: track.counts for name, track in tracks.items()},
        derived=frozenset(CHANNELS[name] for name in plain),
    )


def _is_plain(stand: Stand) -> bool:
    """Whether the drive is polled for its position, having no counted ring."""
    return load_profile(stand.drive.profile).trace.kind == "none"


def _scales(stand: Stand) -> tuple[float, float]:
    units, direction = load_profile(stand.drive.profile).units, stand.drive.direction
    return direction * units.si("position"), direction * units.si("velocity")


def _track(name: str, stream: GaugeStream | RingStream, stand: Stand, word_order: str | None) -> Track:
    config = stand.instruments[name]
    if isinstance(stream, RingStream) and isinstance(config, DriveConfig):
        return ring_track(name, stream, config, word_order)
    if isinstance(stream, GaugeStream) and isinstance(config, GaugeConfig):
        return gauge_track(name, stream, config)
    raise InputError("the stream is not of the instrument's kind", where=name, value=type(stream).__name__)


def gauge_track(name: str, stream: GaugeStream, config: GaugeConfig) -> Track:
    """Decode, fit and count a gauge's stream."""
    codec = load_codec(config.codec, f"{name}.codec")
    frames = codec.scan(stream.raw)
    if len(frames.ends) < 100:
        raise InputError(
            "too short for a clock", where=name, value=f"{len(frames.ends)} frames", remedy="Record longer"
        )
    reads = reads_of(frames, stream, codec.length)
    byte_time = 10.0 / config.link.baud
    fit = fit_gauge(reads, 1 / config.rate, byte_time, codec.length, config.latency, config.latency_uncertainty)
    index = fit.true_index(np.arange(len(frames.ends), dtype=np.int64))
    spent = len(frames.ends) * codec.length + sum(map(len, frames.replies))
    counts = {"samples": len(index), "lost": sum(g.count for g in fit.gaps), "junk": frames.consumed - spent}
    valid = frames.flags == 0 if codec.flagged_is_invalid else np.ones(len(index), dtype=np.bool_)
    if not bool(valid.any()):
        raise InputError("no valid reading", where=name, remedy="Bring the target into the gauge's range")
    return Track(index, frames.values * config.scale, frames.flags, valid, fit.clock, _losses(name, fit), counts)


def reads_of(frames: Frames, stream: GaugeStream, length: int) -> Reads:
    """Of each read that completed or began a frame: its time, whole frames by then, bytes of the next."""
    total = np.cumsum(np.asarray(stream.arrival_bytes, dtype=np.int64))
    whole = np.searchsorted(frames.ends, total, "right").astype(np.int64)
    begins = np.concatenate((frames.ends - length, [np.iinfo(np.int64).max]))
    partial = np.clip(total - begins[whole], 0, length - 1)
    keep = (whole > 0) & (np.diff(whole * length + partial, prepend=-1) > 0)
    return Reads(np.asarray(stream.arrival_time, dtype=np.float64)[keep], whole[keep], partial[keep])


def _losses(name: str, fit: GaugeFit) -> tuple[Loss, ...]:
    found, before = [], 0
    for gap in fit.gaps:
        index = gap.frame + before
        found.append(Loss(name, index, float(fit.clock.time_of(index)), gap.count))
        before += gap.count
    return tuple(found)


def ring_track(name: str, stream: RingStream, config: DriveConfig, word_order: str | None) -> Track:
    """Decode, fit and count the drive's polls."""
    profile = load_profile(config.profile)
    decoder = RingDecoder(profile, name, config.direction)
    decoder.swap = (word_order or profile.encoding.word_order) == "little"
    heads, index, values = [], [], []
    for registers, request, response in zip(stream.registers, stream.request_time, stream.response_time, strict=True):
        block = decoder.decode(RawRegisters(name, registers, float(request), float(response)))
        heads.append(decoder.head)
        if block is not None and block.ticks is not None:
            index.append(block.ticks)
            values.append(block.values)
    if len(heads) < 10 or not index:
        raise InputError("too short for a clock", where=name, value=f"{len(heads)} polls", remedy="Record longer")
    clock = fit_ring(
        np.array(heads, dtype=np.int64),
        np.asarray(stream.request_time, dtype=np.float64),
        np.asarray(stream.response_time, dtype=np.float64),
        1 / profile.trace.clock_hz,
        config.latency,
        config.latency_uncertainty,
        judged=True,
    )
    ticks = np.concatenate(index)
    counts = {"samples": len(ticks), "lost": decoder.overrun, "polls": len(heads)}
    flags = np.zeros(len(ticks), np.uint8)
    return Track(ticks, np.concatenate(values), flags, flags == 0, clock, _overruns(name, ticks, clock), counts)


def _overruns(name: str, ticks: NDArray[np.int64], clock: Clock) -> tuple[Loss, ...]:
    jumps = np.flatnonzero(np.diff(ticks) > 1)
    return tuple(
        Loss(name, int(ticks[i]) + 1, float(clock.time_of(int(ticks[i]) + 1)), int(ticks[i + 1] - ticks[i]) - 1)
        for i in jumps.tolist()
    )


def _on_grid(
    track: Track, grid: Float, counted_slowly: bool
) -> tuple[Float, float, NDArray[np.bool_], NDArray[np.bool_]]:
    """Values [n], one sigma, where no sample was near, and where the device reported a fault."""
    even, there = fill(track.index, track.values, track.valid)
    clock = track.clock
    first = int(track.index[track.valid][0])
    position = (grid - clock.offset) / clock.period - first
    if counted_slowly:
        even, sigma = smooth(even, clock.period)
        speed = np.gradient(even, clock.period)
        sigma = float(np.hypot(sigma, clock.sigma * np.sqrt(np.mean(speed**2))))
    else:
        sigma = noise_of(even[there])
    missing = _far(position, there)
    flagged = np.zeros(len(even), dtype=np.bool_)
    inside = (track.index >= first) & (track.index < first + len(even))
    flagged[track.index[inside & (track.flags > 0)] - first] = True
    nearest = np.clip(np.round(position).astype(np.int64), 0, len(even) - 1)
    return interpolate(even, position), sigma, missing, flagged[nearest]


def _far(position: Float, there: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where a sample that should stand beside the grid's is missing: in a gap, or beyond either end."""
    last = len(there) - 1
    left = np.clip(np.floor(position).astype(np.int64), 0, last)
    right = np.clip(left + 1, 0, last)
    outside = (position < -1) | (position > last + 1)
    far: NDArray[np.bool_] = outside | ~there[left] | ~there[right]
    return far
