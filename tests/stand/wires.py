"""Streams as three instruments would send them over real wires, with the truth beside them; no process, no port."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.clock import GaugeStream, RingStream
from stand.clock.aim import Aim
from stand.config import Stand, load_stand
from stand.excitation.plan import Plan, plan
from stand.excitation.spec import Excitation, Shape

Float = NDArray[np.float64]
HOST = 1000.0
CONVERSION = {"force_gauge": 150e-6, "dial_gauge": 250e-6}
LENGTH = {"force_gauge": 8, "dial_gauge": 15}
JITTER = (1e-4, 3e-4)
MOTIONS = {
    Shape.TRAPEZOIDAL: Excitation(Shape.TRAPEZOIDAL, 1.25, 0.03, 0.2, 10),
    Shape.RECTANGULAR: Excitation(Shape.RECTANGULAR, 1.0, 0.03, 0.0, 8),
    Shape.QUASI_SINUSOIDAL: Excitation(Shape.QUASI_SINUSOIDAL, 0.5, 0.06, 0.0, 4),
}


@dataclass(frozen=True)
class Wires:
    """streams as stored; origin and count of the grid; true x, u, F on it [n]; true first time and period by name."""

    stand: Stand
    streams: dict[str, GaugeStream | RingStream]
    origin: float
    count: int
    truth: dict[str, Float]
    epochs: dict[str, float]
    periods: dict[str, float]


def draw(
    seed: int,
    shape: Shape = Shape.TRAPEZOIDAL,
    *,
    timer: float | None = 0.016,
    off: float = 3e-3,
    lost: dict[str, tuple[tuple[int, int], ...]] | None = None,
    wrong_by_sigma: float = 0.0,
) -> Wires:
    """One run: clocks within 50 ppm (every fifth seed has them exactly right), bunched by a timer or prompt.

    off: how far the timer's period may be off, relative.
    """
    rng = np.random.default_rng(seed)
    stand = load_stand()
    motion = plan(MOTIONS[shape], stand.limits)
    duration = motion.duration
    signals = _signals(motion, rng.uniform(0, 6.28))
    exact = seed % 5 == 0
    drift = {name: 0.0 if exact else float(rng.uniform(-50e-6, 50e-6)) for name in stand.instruments}
    origin = HOST + 0.5
    streams: dict[str, GaugeStream | RingStream] = {}
    epochs, periods, latency = {}, {}, {}
    for name in ("force_gauge", "dial_gauge"):
        period, epoch = 5e-4 / (1 + drift[name]), HOST + float(rng.uniform(0, 0.1))
        time = epoch + period * np.arange(int((duration + 1.0) / period))
        byte_time = 10.0 / stand.instruments[name].link.baud  # type: ignore[union-attr]
        latency[name] = CONVERSION[name] + LENGTH[name] * byte_time + JITTER[0]
        streams[name] = _gauge(
            rng, name, time, signals[name](time - origin), byte_time, timer, off, (lost or {}).get(name, ())
        )
        epochs[name], periods[name] = epoch, period
    epochs["drive"], periods["drive"] = HOST - 2 + float(rng.uniform(0, 1e-3)), 1e-3 / (1 + drift["drive"])
    streams["drive"] = _ring(
        rng, epochs["drive"], periods["drive"], duration + 1.0, lambda t: signals["drive"](t - origin)
    )
    changed = {
        name: stand.instruments[name].model_copy(
            update={"latency": value + wrong_by_sigma * stand.instruments[name].latency_uncertainty}
        )
        for name, value in latency.items()
    }
    grid = np.arange(round(duration * 2000)) / 2000
    truth = {name: signals[name](grid) for name in signals}
    return Wires(stand.model_copy(update=changed), streams, origin, len(grid), truth, epochs, periods)


def _signals(motion: Plan, phase: float) -> dict[str, Callable[[Float], Float]]:
    def x(t: Float) -> Float:
        out: Float = 0.03 + motion.at(t)[0]
        return out

    def u(t: Float) -> Float:
        speed = motion.at(t)[1]
        out: Float = (
            motion.at(t)[0] - 0.004 * speed + 2e-4 * np.sin(2 * np.pi * 16.7 * t + phase) * np.abs(speed) - 0.08
        )
        return out

    def force(t: Float) -> Float:
        moving = motion.at(t)
        out: Float = 15.19 + 3.1 * moving[2] + 40.0 * moving[1] * np.cos(2 * np.pi * 24.0 * t + phase)
        return out

    return {"drive": x, "dial_gauge": u, "force_gauge": force}


def frames_of(name: str, values: Float) -> NDArray[np.uint8]:
    """Frames [n, length] as the instrument sends them."""
    if name == "force_gauge":
        data = b"".join(b"\xaa\x10\xb0" + struct.pack(">f", v) + b"\x85" for v in values)
    else:
        data = b"".join(b"%%01$%+08d**\r" % round(v * 1e7) for v in values)
    return np.frombuffer(data, np.uint8).reshape(len(values), LENGTH[name])


def _gauge(
    rng: np.random.Generator,
    name: str,
    time: Float,
    values: Float,
    byte_time: float,
    timer: float | None,
    off: float,
    lost: tuple[tuple[int, int], ...],
) -> GaugeStream:
    noise = {"force_gauge": 0.12, "dial_gauge": 6e-6}[name]
    frames = frames_of(name, values + rng.normal(0, noise, len(values)))
    kept = np.ones(len(time), dtype=np.bool_)
    for first, count in lost:
        kept[first : first + count] = False
    size = LENGTH[name]
    leaves = (time[kept, None] + CONVERSION[name] + byte_time * np.arange(1, size + 1)).ravel()
    ticks = _ticks(rng, leaves, timer, off)
    total = np.searchsorted(leaves, ticks, "right")
    arrival = ticks + rng.uniform(*JITTER, len(ticks))
    some = np.diff(total, prepend=0) > 0
    total, arrival = total[some], arrival[some]
    raw = frames[kept].ravel()[: total[-1]]
    return GaugeStream(raw, arrival, np.diff(total, prepend=0))


def _ticks(rng: np.random.Generator, leaves: Float, timer: float | None, off: float) -> Float:
    """When bytes are handed over: at a timer's ticks, or some 2 ms apart when a reader comes by."""
    if timer is None:
        return leaves[0] + np.cumsum(rng.uniform(5e-4, 3.5e-3, int((leaves[-1] - leaves[0]) / 2e-3)))
    period = timer * (1 + rng.uniform(-off, off))
    return np.arange(leaves[0] + rng.uniform(0, period), leaves[-1], period)


def _ring(
    rng: np.random.Generator, epoch: float, period: float, seconds: float, position: Callable[[Float], Float]
) -> RingStream:
    count = int((HOST + seconds - epoch) / period)
    true = position(epoch + period * np.arange(count))
    encoder = np.round((true + rng.normal(0, 0.5e-6, count)) / 0.5e-6) * 0.5e-6
    samples = np.round(encoder * 1e7).astype(np.int64)
    request, read, response = _polls(rng, epoch, period, int((seconds - 0.05) * 100))
    heads = np.floor((read - epoch) / period).astype(np.int64) + 1
    polls = np.array([_poll(int(h), samples) for h in heads], dtype=np.uint16)
    return RingStream(polls, request, response)


def _polls(rng: np.random.Generator, epoch: float, period: float, count: int) -> tuple[Float, Float, Float]:
    """When each poll is asked, read in the drive and answered, as the reader aims them; s [count] each."""
    aim, due = Aim(0.01, 1e-3, 1.2e-3, int(rng.integers(1 << 30))), HOST + 0.02
    found = []
    for _ in range(count):
        request = aim.next(due) + 50e-6 + rng.exponential(30e-6)
        read = request + 70e-6 + rng.exponential(40e-6)
        response = read + 70e-6 + rng.exponential(40e-6)
        found.append((request, read, response))
        aim.polled(int((read - epoch) / period) + 1, request, response)
        due += 0.01
    request, read, response = np.array(found).T
    return request, read, response


def _poll(head: int, samples: NDArray[np.int64]) -> list[int]:
    cells = np.zeros(60, np.int64)
    recent = np.arange(max(1, head - 60), head)
    cells[recent % 60] = samples[recent] - samples[recent - 1]
    newest = int(samples[head - 1]) if head else 0
    return list(struct.unpack(">64H", struct.pack(">Ii60h", head, newest, *cells.tolist())))
