"""The drive on Modbus TCP and RTU: pymodbus servers whose every access meets the living drive."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable
from typing import Any, Protocol

from pymodbus.constants import ExcCodes
from pymodbus.server import ModbusSerialServer
from pymodbus.simulator import DataType, SimData, SimDevice

from mocks.devices.quick import QuickServer
from mocks.wire.canopen import Access, ObjectError, request_for

BLOCK = 64
_READ, _WRITE = (3, 4), (6, 16, 23)
Action = Callable[[int, int, int, int, list[int], Any], Awaitable[ExcCodes | None]]


class Registers(Protocol):
    """A drive as blocks of registers and objects; ObjectError where it refuses. Both see the drive as it is now."""

    bases: tuple[int, ...]

    def read_block(self, base: int) -> list[int] | None: ...
    def write_block(self, base: int, first: int, values: list[int]) -> None: ...
    def access(self, index: int, sub: int, data: bytes | None, length: int) -> bytes: ...


def device(registers: Registers) -> SimDevice:
    """The registers as pymodbus serves them: any unit id, functions 3, 4, 6, 16, 23."""

    async def action(
        function: int, start: int, address: int, count: int, live: list[int], values: Any
    ) -> ExcCodes | None:
        if function not in _READ and function not in _WRITE:
            return ExcCodes.ILLEGAL_FUNCTION
        base = max(b for b in registers.bases if b <= address)
        try:
            if values is not None:
                registers.write_block(base, address - base, list(values))
            elif (found := registers.read_block(base)) is not None:
                live[base - start : base - start + len(found)] = found
        except ObjectError:
            return ExcCodes.ILLEGAL_ADDRESS
        except (ValueError, OverflowError):
            return ExcCodes.ILLEGAL_VALUE
        return None

    data = [SimData(base, count=BLOCK, values=0, datatype=DataType.REGISTERS) for base in registers.bases]
    return SimDevice(id=0, simdata=data, action=action)


class DriveServers:
    """Both servers, in the running asyncio loop. port: of TCP once started; live: blocks that have no memory."""

    def __init__(
        self, registers: Registers, live: tuple[int, ...], port: int = 0, rtu: str | None = None, baud: int = 115_200
    ) -> None:
        self.registers, self.live, self.port, self.rtu, self.baud = registers, live, port, rtu, baud
        access: Access = registers.access
        self._pdu: list[Any] = [request_for(access)]
        self._tcp: Any = None
        self._serial: Any = None

    async def start(self) -> None:
        """Listen; the port is the system's where it was 0."""
        await self.listen()
        if self.rtu:
            self._serial = ModbusSerialServer(
                device(self.registers), port=self.rtu, baudrate=self.baud, custom_pdu=self._pdu
            )
            await self._serial.serve_forever(background=True)

    async def listen(self) -> None:
        """The TCP side alone."""
        context, address = device(self.registers), ("127.0.0.1", self.port)
        self._tcp = QuickServer(self.registers, self.live, context, address=address, custom_pdu=self._pdu)
        await self._tcp.serve_forever(background=True)
        self.port = self._tcp.transport.sockets[0].getsockname()[1]

    async def break_off(self, seconds: float) -> None:
        """Every TCP connection ends; nobody answers at the port for a while."""
        if self._tcp:
            await self._tcp.shutdown()
            self._tcp = None
        await asyncio.sleep(seconds)
        await self.listen()

    async def stop(self) -> None:
        """Close both."""
        for server in (self._tcp, self._serial):
            if server:
                await server.shutdown()


class LockedRegisters:
    """A drive's registers under the stand's lock, the plant advanced to the moment of the access."""

    def __init__(self, drive: Any, bases: tuple[int, ...], lock: Any, advance: Callable[[float], None]) -> None:
        self.drive, self.bases, self.lock, self.advance = drive, bases, lock, advance
        self.looks: list[float] | None = None

    def read_block(self, base: int) -> list[int] | None:
        """The block as it is now."""
        with self.lock:
            self._now()
            found: list[int] | None = self.drive.read_block(base)
            return found

    def write_block(self, base: int, first: int, values: list[int]) -> None:
        """Written now."""
        with self.lock:
            self._now()
            self.drive.write_block(base, first, values)

    def access(self, index: int, sub: int, data: bytes | None, length: int) -> bytes:
        """An object, now."""
        with self.lock:
            self._now()
            found: bytes = self.drive.access(index, sub, data, length)
            return found

    def _now(self) -> None:
        self.advance(time.monotonic())  # what the plant is behind: then the drive's look at itself is soon answered
        now = time.monotonic()
        if self.looks is not None:
            self.looks.append(now)
        self.advance(now)
