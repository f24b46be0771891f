"""GSV-8 / GSV-6 binary (ME-Systeme, gsv86lib's protocol table): measuring frames, commands, answers."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numba import njit
from numpy.typing import NDArray

PREFIX, SUFFIX = 0xAA, 0x85
FRAME_BYTES = 8
OK, UNKNOWN, FRAME_ERROR, PARAMETER = 0x00, 0x40, 0x42, 0x50
_REQUEST, _ANSWER, _MEASURED, _FLOAT = 0x90, 0x50, 0x10, 0xB0


def frames(values: NDArray[np.float64], overload: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Measuring frames uint8 [n, 8] for values [n] in N: AA 10 B0 f f f f 85, status B1 where overloaded."""
    data: NDArray[np.uint8] = _frames(values.astype(np.float32).view(np.uint32), overload)
    return data


@njit(cache=True)
def _frames(bits, overload):  # type: ignore[no-untyped-def]
    data = np.empty((bits.size, FRAME_BYTES), np.uint8)
    for i in range(bits.size):
        data[i, 0], data[i, 1], data[i, 7] = PREFIX, _MEASURED, SUFFIX
        data[i, 2] = _FLOAT | overload[i]
        for k in range(4):
            data[i, 3 + k] = (bits[i] >> np.uint32(24 - 8 * k)) & np.uint32(0xFF)
    return data


def sent(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """What a reader of the frames gets for values [n]."""
    return values.astype(np.float32).astype(np.float64)


def answer(error: int, payload: bytes = b"") -> bytes:
    """An answer to a command: AA 5n error payload 85."""
    return bytes((PREFIX, _ANSWER | len(payload), error)) + payload + bytes((SUFFIX,))


@dataclass
class Requests:
    """Finds commands in what the host sends: AA 9n command parameters 85; what is none is passed over."""

    buffer: bytearray = field(default_factory=bytearray)

    def feed(self, data: bytes) -> list[tuple[int, bytes]]:
        """Whole commands as (number, parameters)."""
        self.buffer += data
        found = []
        while (start := self.buffer.find(PREFIX)) >= 0:
            del self.buffer[:start]
            if len(self.buffer) < 2:
                break
            size = 4 + (self.buffer[1] & 0x0F)
            if self.buffer[1] & 0xF0 != _REQUEST:
                del self.buffer[:1]
            elif len(self.buffer) < size:
                break
            elif self.buffer[size - 1] != SUFFIX:
                del self.buffer[:1]
            else:
                found.append((self.buffer[2], bytes(self.buffer[3 : size - 1])))
                del self.buffer[:size]
        if PREFIX not in self.buffer:
            self.buffer.clear()
        return found


@dataclass
class Amplifier:
    """The amplifier's settings and its answers; what it does to the stream is told through the callables.

    value: the newest value in N. zero: subtract the present value. start: stream on or off.
    rate: set, or read with None.
    """

    value: Callable[[], float]
    zero: Callable[[], None]
    start: Callable[[bool], None]
    rate: Callable[[float | None], float]
    serial: int = 20_261_121
    firmware: int = 0x0126
    unit: int = 3
    scale: float = 1.0
    offset: float = 0.0
    mode: int = 0
    transmission: int = 0
    input_type: int = 0

    def reply(self, command: int, parameters: bytes) -> bytes:
        """The answer to a command, which is carried out; 3Bh is answered with a measuring frame."""
        if command == 0x3B:
            return frames(np.array([self.value()]), np.array([False])).tobytes()
        handler = self._handlers().get(command)
        if handler is None:
            return answer(UNKNOWN)
        try:
            return answer(OK, handler(parameters))
        except (ValueError, IndexError, struct.error):
            return answer(PARAMETER)

    def _handlers(self) -> dict[int, Callable[[bytes], bytes]]:
        return {
            0x01: lambda p: bytes((0x02,)),
            0x0A: lambda p: b"",
            0x0C: lambda p: self._no_data(self.zero),
            0x0F: lambda p: bytes((self.unit,)),
            0x10: self._set_unit,
            0x11: lambda p: b"N".ljust(8, b"\0"),
            0x14: lambda p: struct.pack(">f", self.scale),
            0x15: lambda p: self._keep("scale", p),
            0x1F: lambda p: struct.pack(">I", self.serial),
            0x23: lambda p: self._no_data(lambda: self.start(False)),
            0x24: lambda p: self._no_data(lambda: self.start(True)),
            0x26: lambda p: struct.pack(">I", self.mode),
            0x27: self._set_mode,
            0x2B: lambda p: struct.pack(">H", self.firmware),
            0x80: lambda p: bytes((self.transmission,)),
            0x81: self._set_transmission,
            0x8A: lambda p: struct.pack(">f", self.rate(None)),
            0x8B: lambda p: self._no_data(lambda: self.rate(struct.unpack(">f", p)[0])),
            0x9A: lambda p: struct.pack(">f", self.offset),
            0x9B: lambda p: self._keep("offset", p),
            0xA2: lambda p: struct.pack(">I", self.input_type),
        }

    def _no_data(self, act: Callable[[], object]) -> bytes:
        act()
        return b""

    def _set_unit(self, parameters: bytes) -> bytes:
        if parameters[-1] != 3:
            raise ValueError("this gauge gives newtons only")
        return b""

    def _set_mode(self, parameters: bytes) -> bytes:
        (self.mode,) = struct.unpack(">I", parameters)
        return b""

    def _set_transmission(self, parameters: bytes) -> bytes:
        if len(parameters) not in (1, 3):
            raise ValueError("one byte, or an index and two")
        self.transmission = parameters[-1]
        return b""

    def _keep(self, name: str, parameters: bytes) -> bytes:
        (value,) = struct.unpack(">f", parameters[-4:])
        setattr(self, name, value)
        return b""
