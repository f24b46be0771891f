"""A small drive controller on real TCP in the maps of three published drives, each written from its manual's table.

It knows nothing of the profiles that it judges: CiA 402 states, profile position, profile velocity, one fault.
"""

from __future__ import annotations

import asyncio
import struct
import threading
import time
from collections.abc import Mapping
from typing import Any

from pymodbus.constants import ExcCodes
from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

from mocks.devices.cia402 import State, after, statusword
from mocks.wire.canopen import ObjectError, request_for

#: object -> struct format of its value
OBJECTS = {
    0x603F: "H", 0x6040: "H", 0x6041: "H", 0x6060: "b", 0x6061: "b", 0x6064: "i", 0x606C: "i", 0x607A: "i",
    0x6081: "I", 0x6083: "I", 0x6084: "I", 0x6085: "I", 0x605A: "h", 0x6098: "b", 0x60FF: "i", 0x60F4: "i",
}  # fmt: skip
#: Lexium 32: first register of a parameter -> the object that it stands for; 32 bits each, high word first
LEXIUM = {
    6914: 0x6040, 6916: 0x6041, 6918: 0x6060, 6920: 0x6061, 6936: 0x6098, 6938: 0x60FF, 6940: 0x607A, 6942: 0x6081,
    1556: 0x6083, 1558: 0x6084, 7706: 0x6064, 7744: 0x606C, 15362: 0x603F,
}  # fmt: skip
LEXIUM_LIMITS = (1544, 1546)
SET_POINT, REACHED, ACKNOWLEDGED = 0x10, 1 << 10, 1 << 12


class Axis:
    """The drive behind the map; a count is `scale` m."""

    def __init__(self, scale: float) -> None:
        self.scale, self.state = scale, State.DISABLED
        self.values = dict.fromkeys(OBJECTS, 0)
        self.position, self.target, self.at = 0.0, 0.0, time.monotonic()

    def fault(self, code: int) -> None:
        self.advance()
        self.state, self.values[0x603F] = State.FAULT, code

    def advance(self) -> None:
        """Straight to the target at the profile velocity, or along at the target velocity."""
        now = time.monotonic()
        step, self.at = now - self.at, now
        if self.state is not State.ENABLED:
            return
        if self.values[0x6060] == 3:
            self.position += step * self.values[0x60FF]
        elif self.values[0x6060] == 1:
            reach = step * self.values[0x6081]
            self.position += max(-reach, min(reach, self.target - self.position))

    def read(self, index: int) -> int:
        self.advance()
        reached = REACHED if self.position == self.target else 0
        acknowledged = ACKNOWLEDGED if self.values[0x6040] & SET_POINT else 0
        live = {
            0x6041: statusword(self.state, self.values[0x6040], bits=reached | acknowledged),
            0x6061: self.values[0x6060],
            0x6064: round(self.position),
        }
        return live.get(index, self.values[index])

    def write(self, index: int, value: int) -> None:
        self.advance()
        before, self.values[index] = self.values[index], value
        if index != 0x6040:
            return
        if self.state is State.FAULT:
            if value & ~before & 0x80:
                self.state, self.values[0x603F] = State.DISABLED, 0
            return
        self.state = after(self.state, value)
        if self.state is State.ENABLED and value & ~before & SET_POINT:
            self.target = float(self.values[0x607A])


class Registers:
    """The axis as registers: the object's index itself (low word first), or the Lexium's parameters."""

    def __init__(self, axis: Axis, lexium: bool) -> None:
        self.axis, self.lexium = axis, lexium
        self.limits = dict.fromkeys(LEXIUM_LIMITS, 0)

    def read(self, address: int, count: int) -> list[int]:
        data = self._data(address)
        if count * 2 != len(data):
            raise ObjectError(f"{count} registers at {address}")
        words = list(struct.unpack(f">{count}H", data))
        return words if self.lexium else words[::-1]

    def _data(self, address: int) -> bytes:
        if self.lexium and address in self.limits:
            return struct.pack(">i", self.limits[address])
        index = LEXIUM.get(address, 0) if self.lexium else address
        if index not in OBJECTS:
            raise ObjectError(f"nothing at {address}")
        value, kind = self.axis.read(index), OBJECTS[index]
        if self.lexium:
            return struct.pack(">I", value & 0xFFFFFFFF)
        return struct.pack(">I" if kind in "iI" else ">H", value & (0xFFFFFFFF if kind in "iI" else 0xFFFF))

    def write(self, address: int, words: list[int]) -> None:
        value = int.from_bytes(struct.pack(f">{len(words)}H", *(words if self.lexium else words[::-1])), "big")
        if self.lexium and address in self.limits:
            self.limits[address] = value
            return
        index = LEXIUM.get(address, 0) if self.lexium else address
        if index not in OBJECTS or len(words) != len(self._data(address)) // 2:
            raise ObjectError(f"nothing of {len(words)} registers at {address}")
        size = struct.calcsize(OBJECTS[index])
        self.axis.write(index, struct.unpack(f"<{OBJECTS[index]}", value.to_bytes(4, "little")[:size])[0])

    def device(self) -> SimDevice:
        async def action(function: int, start: int, at: int, count: int, live: list[int], new: Any) -> ExcCodes | None:
            try:
                if new is not None:
                    self.write(at, list(new))
                else:
                    live[at - start : at - start + count] = self.read(at, count)
            except ObjectError:
                return ExcCodes.ILLEGAL_ADDRESS
            return None

        data = SimData(0, count=0x7000, values=0, datatype=DataType.REGISTERS)
        return SimDevice(id=0, simdata=[data], action=action)


class Controller:
    """Serves while entered. kind: direct, table or mei13."""

    def __init__(self, kind: str, scale: float) -> None:
        self.axis, self.port = Axis(scale), 0
        self._registers = Registers(self.axis, lexium=kind == "table")
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._server: Any = None

    def _object(self, index: int, sub: int, data: bytes | None, length: int) -> bytes:
        """Function 43/13; limits and identity are taken and given without use."""
        kind = OBJECTS.get(index)
        if kind is None or sub:
            if index in (0x607D, 0x1018):
                return bytes(4) if data is None else b""
            raise ObjectError(f"{index:04X}")
        if data is None:
            return struct.pack(f"<{kind}", self.axis.read(index))
        self.axis.write(index, struct.unpack(f"<{kind}", data)[0])
        return b""

    def __enter__(self) -> Controller:
        self._thread.start()
        asyncio.run_coroutine_threadsafe(self._listen(), self._loop).result(5.0)
        return self

    async def _listen(self) -> None:
        own: Mapping[str, Any] = {"custom_pdu": [request_for(self._object)]}
        self._server = ModbusTcpServer(self._registers.device(), address=("127.0.0.1", 0), **own)
        await self._server.serve_forever(background=True)
        self.port = self._server.transport.sockets[0].getsockname()[1]

    def __exit__(self, *_: object) -> None:
        asyncio.run_coroutine_threadsafe(self._server.shutdown(), self._loop).result(5.0)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(5.0)
