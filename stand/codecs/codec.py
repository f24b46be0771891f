"""What a streaming instrument's language is, and the feeder that reads it from a byte stream."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import stand.codecs
from stand.block import Block
from stand.errors import InputError

Bytes = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Frames:
    """What a scan found. ends: int64 [n], offset just past each frame; values: float64 [n], SI; flags: uint8 [n].

    consumed: bytes that no later byte can make part of a frame. replies: the device's answers to commands.
    """

    ends: NDArray[np.int64]
    values: NDArray[np.float64]
    flags: NDArray[np.uint8]
    consumed: int
    replies: tuple[bytes, ...] = ()


@dataclass(frozen=True)
class Codec:
    """A plug-in: data and functions.

    unit: SI unit of the values. length: bytes in a frame. scan(buffer): all whole frames in it, in order; what it
    finds in a prefix it finds again in the whole. start, stop: what makes the device stream and be silent;
    zero, rate(hz): commands; empty where it has none. identify: name -> (command, decode(reply)).
    check_reply: empty where the device agreed, else its complaint. flagged_is_invalid: such a value is no reading.
    """

    name: str
    title: str
    source: str
    unit: str
    length: int
    scan: Callable[[Bytes], Frames]
    start: bytes = b""
    stop: bytes = b""
    zero: bytes = b""
    rate: Callable[[float], bytes] = lambda hz: b""
    identify: Mapping[str, tuple[bytes, Callable[[bytes], str]]] = field(default_factory=dict)
    check_reply: Callable[[bytes], str] = lambda reply: ""
    flagged_is_invalid: bool = False


def starts(candidates: NDArray[np.int64], length: int) -> NDArray[np.int64]:
    """Of ascending candidate offsets, those that a reader from the left takes: none overlaps the one before."""
    if len(candidates) < 2 or int(np.min(np.diff(candidates))) >= length:
        return candidates
    taken, free = [], -1
    for offset in candidates.tolist():
        if offset >= free:
            taken.append(offset)
            free = offset + length
    return np.array(taken, dtype=np.int64)


class Feeder:
    """The state of one stream: what is left of the last read, and counts. No clock, no port."""

    def __init__(self, codec: Codec, instrument: str) -> None:
        self.codec, self.instrument = codec, instrument
        self.count = self.junk = 0
        self.replies: list[bytes] = []
        self._rest: Bytes = np.empty(0, np.uint8)

    def feed(self, data: bytes, arrival: float) -> Block:
        """The block of samples that `data` completes, empty if none; junk in it is skipped and counted."""
        buffer = np.concatenate((self._rest, np.frombuffer(data, np.uint8)))
        frames = self.codec.scan(buffer)
        self._rest = buffer[frames.consumed :]
        self.replies.extend(frames.replies)
        spent = len(frames.ends) * self.codec.length + sum(map(len, frames.replies))
        skipped = frames.consumed - spent
        first, self.count, self.junk = self.count, self.count + len(frames.ends), self.junk + skipped
        tail = len(self._rest)
        span = len(buffer) - int(frames.ends[0]) + self.codec.length if len(frames.ends) else 0
        return Block(self.instrument, first, frames.values, None, frames.flags, arrival, skipped, tail=tail, span=span)


def names() -> tuple[str, ...]:
    """The codecs in the folder, by name."""
    modules = (m.name for m in pkgutil.iter_modules(stand.codecs.__path__))
    return tuple(sorted(name.replace("_", "-") for name in modules if name != "codec"))


def load_codec(name: str, where: str = "codec") -> Codec:
    """The codec `name`; InputError that lists the known ones where there is none of that name."""
    if name not in names():
        raise InputError("no codec of that name", where=where, value=name, remedy=f"Known: {', '.join(names())}")
    module = importlib.import_module(f"stand.codecs.{name.replace('-', '_')}")
    found = [value for key, value in vars(module).items() if isinstance(value, Codec) and not key.startswith("_")]
    if len(found) != 1:
        raise TypeError(f"{module.__name__} must hold one public Codec, it holds {len(found)}")
    return found[0]
