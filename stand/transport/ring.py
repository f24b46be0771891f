"""The drive's counted position ring: registers in, samples out; sans-IO."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stand.block import Block
from stand.drive.profile import DriveProfile
from stand.transport.raw import RawRegisters
from stand.units import conversion

_DTYPES = {"u16": ">u2", "u32": ">u4", "i16": ">i2", "i32": ">i4"}
_WORDS = {"u16": 1, "i16": 1, "u32": 2, "i32": 2}


class RingDecoder:
    """Unwraps the head counter and finds what is new; one for each connection.

    scale: SI of one count. `overrun` counts samples that the ring had overwritten before they were read.
    """

    def __init__(self, profile: DriveProfile, instrument: str = "drive", direction: int = 1) -> None:
        trace = profile.trace
        self.trace, self.instrument, self.direction = trace, instrument, direction
        self.scale = trace.scale * conversion(trace.unit, "m", f"{profile.profile.name}: trace.unit")
        self.swap = profile.encoding.word_order == "little"
        self.head_words, self.record_words = _WORDS[trace.head_type], _WORDS[trace.record]
        self.count = self.record_words * trace.depth + (trace.base - trace.head)
        self.overrun = 0
        self.head: int | None = None

    def read_head(self, registers: NDArray[np.uint16]) -> int:
        """The number of samples written so far, unwrapped against the head before."""
        raw = int(self._numbers(registers[: self.head_words], self.trace.head_type)[0])
        if self.head is None:
            return raw
        modulus = 1 << (16 * self.head_words)
        return self.head + (raw - self.head) % modulus

    def samples(self, registers: NDArray[np.uint16], begin: int, head: int) -> NDArray[np.float64]:
        """Samples begin to head - 1, all of which the ring still holds, in SI, float64 [head - begin]."""
        offset = self.trace.base - self.trace.head
        slots = self._numbers(registers[offset : offset + self.record_words * self.trace.depth], self.trace.record)
        slots = slots[np.arange(begin, head) % self.trace.depth].astype(np.int64)
        if self.trace.newest is not None:
            at = self.trace.newest - self.trace.head
            newest = int(self._numbers(registers[at : at + 2], "i32")[0])
            slots = newest - (slots.sum() - np.cumsum(slots))
        return self.direction * slots.astype(np.float64) * self.scale

    def decode(self, raw: RawRegisters) -> Block | None:
        """The samples that are new in this poll; None where there is none, or at the first poll."""
        head, before = self.read_head(raw.registers), self.head
        self.head = head
        depth = self.trace.depth
        begin = max(head - depth, 0) if before is None else before
        if head - begin > depth:
            self.overrun += head - begin - depth
            begin = head - depth
        if head <= begin:
            return None
        ticks = np.arange(begin, head, dtype=np.int64)
        values = self.samples(raw.registers, begin, head)
        flags = np.zeros(len(ticks), np.uint8)
        return Block(self.instrument, begin, values, ticks, flags, raw.response, request=raw.request)

    def _numbers(self, words: NDArray[np.uint16], kind: str) -> NDArray[np.generic]:
        """Numbers of a kind; differences lie two to a 32-bit number, and turn with its words."""
        if self.swap and (_WORDS[kind] == 2 or self.trace.newest is not None):
            words = words.reshape(-1, 2)[:, ::-1].reshape(-1)
        return np.ascontiguousarray(words).astype(">u2").view(_DTYPES[kind])
