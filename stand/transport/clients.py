"""pymodbus' clients, one for each kind of wire, told to fail aloud, not to lock the port and to read promptly."""

from __future__ import annotations

import logging
import os
import select
import socket
from collections.abc import Callable
from typing import Protocol

import serial
from pymodbus.client import ModbusSerialClient, ModbusTcpClient
from pymodbus.framer import FramerBase
from pymodbus.pdu import ModbusPDU

from stand.config import RtuLink, TcpLink
from stand.transport.heard import ROOM, age, ask_for_stamps
from stand.transport.modbus import ObjectAnswer

Trace = Callable[[bool, bytes], bytes]
CLOSED = "the connection was closed"


class Client(Protocol):
    """What a link needs of either."""

    framer: FramerBase
    late: float

    def connect(self) -> bool: ...
    def close(self) -> None: ...
    def execute(self, no_response_expected: bool, request: ModbusPDU, /) -> ModbusPDU: ...


# what goes wrong is told once, by the link, and not on the side
logging.getLogger("pymodbus").addHandler(logging.NullHandler())


class PromptTcp(ModbusTcpClient):
    """Connecting raises OSError with its reason. late: how long before the last read the host had the bytes, s."""

    late = 0.0

    def connect(self) -> bool:
        """Connect, unless connected."""
        if self.socket is None:
            address, timeout = (self.comm_params.host, self.comm_params.port), self.comm_params.timeout_connect
            self.socket = socket.create_connection(address, timeout)
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            ask_for_stamps(self.socket)
        return True

    def recv(self, size: int | None) -> bytes:
        """What is there, waiting for its first byte; nothing after the timeout."""
        link = self.socket
        if link is None or link.fileno() < 0:  # closed meanwhile, from another thread
            raise ConnectionAbortedError(CLOSED)
        if not select.select([link], [], [], self.comm_params.timeout_connect)[0]:
            return b""
        data, notes, _, _ = link.recvmsg(size or 4096, ROOM)
        self.late = age(notes)
        if not data:
            raise ConnectionResetError(CLOSED)
        return data


class PromptSerial(ModbusSerialClient):
    """The port stays open to the guardian's own handle; bytes are taken as they come, not in steps of 1 ms."""

    late = 0.0

    def connect(self) -> bool:
        """Open the port, unless open; OSError or termios.error with its reason."""
        if self.socket is None:
            wire = self.comm_params
            self.socket = serial.Serial(
                wire.host, wire.baudrate, parity=wire.parity, stopbits=wire.stopbits, exclusive=False
            )
        return True

    def recv(self, size: int | None) -> bytes:
        """What is there, waiting for its first byte; nothing after the timeout."""
        assert self.socket is not None
        handle = self.socket.fileno()
        if not select.select([handle], [], [], self.comm_params.timeout_connect)[0]:
            return b""
        return os.read(handle, size or 512)


def make_client(link: TcpLink | RtuLink, trace: Trace) -> Client:
    """A client, not yet connected. It never sends twice: a repeated write would repeat a motion command."""
    client: ModbusTcpClient | ModbusSerialClient
    if isinstance(link, TcpLink):
        client = PromptTcp(link.host, port=link.port, timeout=link.timeout, retries=0, trace_packet=trace)
    else:
        client = PromptSerial(
            link.port, baudrate=link.baud, parity=link.parity, stopbits=link.stopbits,
            timeout=link.timeout, retries=0, trace_packet=trace,
        )  # fmt: skip
    client.register(ObjectAnswer)
    return client
