"""Panasonic HL-G1 ASCII: the continuous output of 15 characters a value, and its requests."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numba import njit
from numpy.typing import NDArray

FRAME_BYTES = 15
UNIT = 1e-7  # m
ALARM = 9_500_000  # counts that say: no valid value
_TEMPLATE = np.frombuffer(b"%01$+0000000**\r", np.uint8)


def counts(values: NDArray[np.float64], alarm: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Values [n] in m as counts of 0.1 um; ALARM where the gauge has none or is out of its +-950 mm."""
    found: NDArray[np.int64] = _counts(values, alarm)
    return found


@njit(cache=True)
def _counts(values, alarm):  # type: ignore[no-untyped-def]
    found = np.empty(values.size, np.int64)
    for i in range(values.size):
        count = np.int64(np.rint(values[i] / UNIT))
        found[i] = ALARM if alarm[i] or abs(count) >= ALARM else count
    return found


def frames(found: NDArray[np.int64]) -> NDArray[np.uint8]:
    """Continuous output uint8 [n, 15] for counts [n]: %01$+0025000**CR."""
    data: NDArray[np.uint8] = _frames(found, _TEMPLATE)
    return data


@njit(cache=True)
def _frames(found, template):  # type: ignore[no-untyped-def]
    data = np.empty((found.size, FRAME_BYTES), np.uint8)
    for i in range(found.size):
        data[i] = template
        if found[i] < 0:
            data[i, 4] = 45
        left = abs(found[i])
        for k in range(11, 4, -1):
            data[i, k] = 48 + left % 10
            left //= 10
    return data


def bcc(text: bytes) -> bytes:
    """Block check: exclusive or of all characters before it, two hexadecimal digits."""
    code = 0
    for character in text:
        code ^= character
    return b"%02X" % code


@dataclass
class Requests:
    """Finds requests in what the host sends: %01#CCC data bb CR."""

    buffer: bytearray = field(default_factory=bytearray)

    def feed(self, data: bytes) -> list[bytes]:
        """Whole requests without their CR."""
        self.buffer += data
        *lines, rest = bytes(self.buffer).split(b"\r")
        self.buffer = bytearray(rest[-64:])
        return [line[line.rfind(b"%") :] for line in lines if b"%" in line]


@dataclass
class Sensor:
    """The sensor's answers. value: newest counts. start: stream on or off. rate: Hz, set, or read with None."""

    value: Callable[[], int]
    start: Callable[[bool], None]
    rate: Callable[[float | None], float]
    intensity: int = 2130
    station: bytes = b"01"

    def reply(self, request: bytes) -> bytes:
        """The answer; empty where the request is another station's or its check fails."""
        if len(request) < 9 or request[1:3] != self.station or request[3:4] != b"#":
            return b""
        body, check = request[:-2], request[-2:]
        if check not in (b"**", bcc(body)):
            return self._error(b"01")
        return self._answer(body[4:7], body[7:])

    def _answer(self, command: bytes, data: bytes) -> bytes:
        if command == b"WSP":
            return self._set_period(data)
        texts: dict[bytes, Callable[[], bytes]] = {
            b"RMD": lambda: b"%+08d" % self.value(),
            b"RMB": lambda: b"%+08d%+08d000%d" % (self.value(), self.intensity, self._alarm()),
            b"RSP": lambda: b"%+06d" % {5000.0: 0, 2000.0: 1, 1000.0: 2, 500.0: 3}.get(self.rate(None), 9),
            b"RID": lambda: b"%+08d" % self.intensity,
            b"ROA": lambda: b"%d" % self._alarm(),
        }
        return self._sent(command + texts[command]()) if command in texts else self._error(b"02")

    def _alarm(self) -> int:
        return int(abs(self.value()) >= ALARM)

    def _set_period(self, data: bytes) -> bytes:
        periods = {0: 5000.0, 1: 2000.0, 2: 1000.0, 3: 500.0}
        try:
            self.rate(periods[int(data)])
        except (KeyError, ValueError):
            return self._error(b"03")
        return self._sent(b"WSP")

    def _sent(self, text: bytes) -> bytes:
        return b"%" + self.station + b"$" + text + b"**\r"

    def _error(self, code: bytes) -> bytes:
        return b"%" + self.station + b"!" + code + b"**\r"
