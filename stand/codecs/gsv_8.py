"""ME-Systeme GSV-8 and GSV-6: binary frames AA 10 Bx f32 85, one channel (gsv86lib; me-systeme.de, gsvmulti)."""

from __future__ import annotations

import struct

import numpy as np

from stand.codecs.codec import Bytes, Codec, Frames

LENGTH = 8
HEAD, TAIL = 0xAA, 0x85
_OVERLOAD = 0x01
_ERRORS = {
    0x40: "unknown command",
    0x41: "not implemented",
    0x42: "malformed command",
    0x91: "transmit overflow",
    0x92: "busy",
    0x99: "receive buffer full",
}


def command(code: int, parameters: bytes = b"") -> bytes:
    """AA | 90h + n | command | n parameter bytes | 85."""
    return bytes((HEAD, 0x90 | len(parameters), code)) + parameters + bytes((TAIL,))


def scan(buffer: Bytes) -> Frames:
    """Measuring frames (float32 big-endian, N) and answers (AA | 50h + n | error | payload | 85) in `buffer`."""
    frames: list[int] = []
    replies: list[tuple[int, int]] = []
    free, consumed = 0, len(buffer)
    for start, length in _heads(buffer):
        if start < free:
            continue
        free = start + length
        if free > len(buffer):
            consumed = start
            break
        if buffer[start + 1] == 0x10:
            frames.append(start)
        else:
            replies.append((start, length))
    begin = np.array(frames, dtype=np.int64)
    rows = buffer[begin[:, None] + np.arange(LENGTH)]
    values = rows[:, 3:7].copy().view(">f4")[:, 0].astype(np.float64)
    flags = (rows[:, 2] & _OVERLOAD).astype(np.uint8)
    return Frames(begin + LENGTH, values, flags, consumed, tuple(buffer[a : a + n].tobytes() for a, n in replies))


def _heads(buffer: Bytes) -> list[tuple[int, int]]:
    """Offset and length of everything that is, or may yet become, a frame or an answer."""
    n = len(buffer)
    padded = np.concatenate((buffer, np.zeros(20, np.uint8)))
    heads = np.flatnonzero(buffer == HEAD)
    kind = padded[heads + 1]
    measure, answer = kind == 0x10, kind & 0xF0 == 0x50
    alone = heads == n - 1
    length = np.where(answer, 4 + (kind & 0x0F).astype(np.int64), LENGTH)
    status = (padded[heads + 2] & 0xFC == 0xB0) | (heads + 2 >= n) | answer
    closed = (padded[heads + length - 1] == TAIL) | (heads + length > n)
    good = alone | ((measure | answer) & status & closed)
    return list(zip(heads[good].tolist(), length[good].tolist(), strict=True))


def check_reply(reply: bytes) -> str:
    """Empty where the device agreed, else its complaint in words."""
    error = reply[2]
    return "" if error in (0x00, 0x01) else _ERRORS.get(error, f"error {error:02X}h")


CODEC = Codec(
    name="gsv-8",
    title="ME-Systeme GSV-8",
    source="gsv86lib 0.1.1; me-systeme.de, GSV-8 data format",
    unit="N",
    length=LENGTH,
    scan=scan,
    start=command(0x24),
    stop=command(0x23),
    zero=command(0x0C, b"\x00"),
    rate=lambda hz: command(0x8B, struct.pack(">f", hz)),
    identify={
        "serial": (command(0x1F), lambda reply: reply[3:-1].hex()),
        "firmware": (command(0x2B), lambda reply: reply[3:-1].hex()),
    },
    check_reply=check_reply,
)
