"""What the recorder keeps of each instrument: the wire's own content, before anything is made of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

from stand.block import Block
from stand.transport.raw import Raw


class Wire(StrEnum):
    """How an instrument's raw stream is kept: a byte stream with arrivals, or register reads with their times."""

    BYTES = "bytes"
    REGISTERS = "registers"


@dataclass(frozen=True, slots=True)
class Happening:
    """One line of `/entry/events`: host time, s (monotonic); kind in one word; text for the operator."""

    at: float
    kind: str
    text: str


@dataclass(frozen=True, slots=True)
class Taken:
    """What a reader hands over at once: the raw read and the samples that it completed, if any."""

    raw: Raw
    block: Block | None


@dataclass(frozen=True, slots=True)
class StreamSpec:
    """One instrument's place in the file.

    rate: samples per second, nominal; width: registers per read; bytes_per_sample, for a byte stream;
    reads_per_second: how often a read returns at most. texts and numbers: identity and calibration, as
    {group: {name: value}} and {group: {name: (value, unit)}}. sampling: in words, how the channel was sampled.
    """

    name: str
    wire: Wire
    unit: str
    rate: float
    sampling: str
    width: int = 0
    bytes_per_sample: int = 1
    reads_per_second: float = 2000.0
    texts: dict[str, dict[str, str]] = field(default_factory=dict)
    numbers: dict[str, dict[str, tuple[float, str]]] = field(default_factory=dict)
