"""One Modbus connection, one request in flight, never a retry: a repeated write would repeat a motion command."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import Protocol

import serial

from stand.config import RtuLink, TcpLink
from stand.errors import DeviceError
from stand.transport.modbus import RtuFraming, TcpFraming, check_answer

Clock = Callable[[], float]


class _Wire(Protocol):
    def send(self, data: bytes) -> None: ...
    def receive(self, size: int) -> bytes: ...
    def close(self) -> None: ...


class _Tcp:
    def __init__(self, link: TcpLink) -> None:
        self._socket = socket.create_connection((link.host, link.port), timeout=link.timeout)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, data: bytes) -> None:
        self._socket.sendall(data)

    def receive(self, size: int) -> bytes:
        return self._socket.recv(512)

    def close(self) -> None:
        self._socket.close()


class _Rtu:
    def __init__(self, link: RtuLink) -> None:
        self._silence, self._last = link.interframe, 0.0
        self._port = serial.Serial(
            link.port, link.baud, parity=link.parity, stopbits=link.stopbits, timeout=link.timeout, exclusive=False
        )

    def send(self, data: bytes) -> None:
        wait = self._last + self._silence - time.monotonic()
        if wait > 0:
            time.sleep(wait)
        self._port.reset_input_buffer()
        self._port.write(data)

    def receive(self, size: int) -> bytes:
        data: bytes = self._port.read(size)
        self._last = time.monotonic()
        return data

    def close(self) -> None:
        self._port.close()


class ModbusLink:
    """A connection to one unit. `transact` is safe from several threads; each waits for its turn."""

    def __init__(self, link: TcpLink | RtuLink, clock: Clock = time.monotonic) -> None:
        self.link, self._clock = link, clock
        self.where = f"{link.host}:{link.port}" if isinstance(link, TcpLink) else link.port
        self._framing = TcpFraming(link.unit_id) if isinstance(link, TcpLink) else RtuFraming(link.unit_id)
        self._lock, self._transaction = threading.Lock(), 0
        self._wire: _Wire | None = None

    def open(self) -> None:
        """Connect; DeviceError where nothing answers there. A link that failed opens anew at the next request."""
        with self._lock:
            self._connect()

    def _connect(self) -> _Wire:
        try:
            self._wire = _Tcp(self.link) if isinstance(self.link, TcpLink) else _Rtu(self.link)
            return self._wire
        except (OSError, serial.SerialException) as error:
            remedy = "Check that the drive is on and the link in the stand's file is right"
            raise DeviceError(f"can't connect ({error})", where=self.where, remedy=remedy) from error

    def close(self) -> None:
        """Disconnect; harmless twice."""
        if self._wire is not None:
            self._wire.close()
            self._wire = None

    def __enter__(self) -> ModbusLink:
        self.open()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, tb: TracebackType | None) -> None:
        self.close()

    def telegram(self, pdu: bytes) -> bytes:
        """The complete telegram of one request, for a connection of someone else's."""
        return self._framing.wrap(pdu, 1)

    def transact(self, pdu: bytes) -> bytes:
        """The answer to one request; DeviceError on silence, refusal or nonsense. Nothing is sent twice."""
        return self.stamped(pdu)[0]

    def stamped(self, pdu: bytes) -> tuple[bytes, float, float]:
        """The answer, with the host's time just before sending and just after the last byte, s."""
        with self._lock:
            wire = self._wire or self._connect()
            self._transaction = (self._transaction + 1) & 0xFFFF
            telegram = self._framing.wrap(pdu, self._transaction)
            try:
                sent = self._clock()
                wire.send(telegram)
                answer = self._receive(wire)
                received = self._clock()
            except (OSError, serial.SerialException) as error:
                self.close()  # a late answer must not be taken for the next one's
                raise DeviceError(f"no answer ({error})", where=self.where, remedy="Check the link") from error
        return check_answer(pdu, self._framing.unwrap(answer), self.where), sent, received

    def _receive(self, wire: _Wire) -> bytes:
        received = b""
        while (missing := self._framing.missing(received)) > 0:
            part = wire.receive(missing)
            if not part:
                raise OSError("silence" if not received else f"only {len(received)} bytes")
            received += part
        return received
