"""One Modbus connection, one request in flight, never a retry: a repeated write would repeat a motion command.

The client is pymodbus'. Its hook before each write and after each read takes the times that the ring's clock needs;
on a real-time thread it answers as fast as bare sockets do (64 registers over loopback: median 0.51 against 0.57 ms).
"""

from __future__ import annotations

import termios
import time
from collections.abc import Callable
from types import TracebackType

from pymodbus.exceptions import ConnectionException, ModbusException, ModbusIOException
from pymodbus.pdu import ModbusPDU

from stand.config import RtuLink, TcpLink
from stand.errors import DeviceError
from stand.transport.clients import CLOSED, make_client
from stand.transport.modbus import check_answer
from stand.transport.turns import Turns, turns_of

Clock = Callable[[], float]


class ModbusLink:
    """A connection to one unit. `transact` is safe from several threads; each waits for its turn."""

    def __init__(self, link: TcpLink | RtuLink, clock: Clock = time.monotonic) -> None:
        self.link, self._clock = link, clock
        self.where = link.port if isinstance(link, RtuLink) else f"{link.host}:{link.port}"
        self._turns = turns_of(link.port) if isinstance(link, RtuLink) else Turns()
        self._silence = link.interframe if isinstance(link, RtuLink) else 0.0
        #: s that a byte needs on the line: by that much less than it seems, on RTU, the device has had the question
        self._byte = (10 + (link.parity != "N") + link.stopbits - 1) / link.baud if isinstance(link, RtuLink) else 0.0
        self._client = make_client(link, self._stamp)
        self._sent, self._received = 0.0, 0.0

    def _stamp(self, sending: bool, data: bytes) -> bytes:
        """Called by the client right before it writes and right after it has read."""
        if sending:
            self._sent = self._clock() + self._byte * len(data)
        else:
            self._received = self._clock() - self._client.late - self._byte * len(data)
        return data

    @property
    def looked(self) -> float:
        """When the device looked at the last question, about: the middle of its times, s."""
        return (self._sent + self._received) / 2

    def open(self) -> None:
        """Connect; DeviceError where nothing answers there. A link that failed opens anew at the next request."""
        with self._turns.take():
            self._connect()

    def _connect(self) -> None:
        try:
            self._client.connect()
        except OSError as error:
            remedy = "Check that the drive is on and the link in the stand's file is right"
            raise DeviceError(f"can't connect ({error})", where=self.where, remedy=remedy) from error
        except termios.error as error:
            remedy = 'Check baud, parity and stop bits; a pseudo-terminal takes no parity but "N"'
            raise DeviceError(f"the port refuses its settings ({error})", where=self.where, remedy=remedy) from error

    def close(self) -> None:
        """Disconnect; harmless twice."""
        self._client.close()

    def __enter__(self) -> ModbusLink:
        self.open()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, tb: TracebackType | None) -> None:
        self.close()

    def telegram(self, request: ModbusPDU) -> bytes:
        """The complete telegram of one request, for a connection of someone else's."""
        request.dev_id, request.transaction_id = self.link.unit_id, 1
        return self._client.framer.buildFrame(request)

    def transact(self, request: ModbusPDU) -> ModbusPDU:
        """The answer to one request; DeviceError on silence, refusal or nonsense. Nothing is sent twice."""
        return self.stamped(request)[0]

    def stamped(self, request: ModbusPDU) -> tuple[ModbusPDU, float, float]:
        """The answer, with the host's times between which the device has looked at the question, s.

        On TCP just before sending and when the host's network had the last byte; on RTU less what the bytes need on
        the line.
        """
        request.dev_id = self.link.unit_id
        with self._turns.take():
            self._connect()
            self._turns.pause(self._silence)
            try:
                answer = self._client.execute(False, request)
            except (OSError, ModbusException, termios.error) as error:
                self.close()  # a late answer must not be taken for the next one's
                raise DeviceError(
                    f"no answer ({self._why(error)})", where=self.where, remedy="Check the link"
                ) from error
            sent, received = self._sent, self._received
        return check_answer(request, answer, self.where), sent, received

    def _why(self, error: Exception) -> str:
        if isinstance(error, ModbusIOException):
            return f"nothing that can be read within {self.link.timeout:g} s"
        return CLOSED if isinstance(error, ConnectionException) else str(error)
