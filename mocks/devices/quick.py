"""Plain register telegrams on Modbus TCP, carried out the moment they arrive; everything else is pymodbus's business.

pymodbus takes three turns of its loop for a request, each of which waits for whatever else the process does: a drive
answers sooner, and above all at the same pace every time.
"""

from __future__ import annotations

import struct
from typing import Any, Protocol

from pymodbus.server import ModbusTcpServer
from pymodbus.server.requesthandler import ServerRequestHandler

from mocks.wire.canopen import ObjectError

READ, WRITE, BOTH = 3, 16, 23
MOST_READ, MOST_WRITTEN = 125, 123
BLOCK = 64
ADDRESS, VALUE = 2, 3


class Blocks(Protocol):
    """A drive's blocks of registers; ObjectError where it refuses."""

    bases: tuple[int, ...]

    def read_block(self, base: int) -> list[int] | None: ...
    def write_block(self, base: int, first: int, values: list[int]) -> None: ...


class QuickServer(ModbusTcpServer):
    """pymodbus's server whose connections look for plain telegrams first. live: bases of blocks that have no memory."""

    def __init__(self, blocks: Blocks, live: tuple[int, ...], context: Any, **known: Any) -> None:
        super().__init__(context, **known)
        self.blocks, self.live = blocks, live

    def callback_new_connection(self) -> ServerRequestHandler:
        """A connection."""
        return _Connection(  # type: ignore[no-untyped-call]
            self, self.trace_packet, self.trace_pdu, self.trace_connect
        )


class _Connection(ServerRequestHandler):
    def callback_data(self, data: bytes, addr: Any = None) -> int:
        """What a host sent."""
        answer = quick_answer(data, self.server.blocks, self.server.live)
        if answer is None:
            used: int = super().callback_data(data, addr)
            return used
        self.send(answer)
        return len(data)


def quick_answer(telegram: bytes, blocks: Blocks, live: tuple[int, ...]) -> bytes | None:
    """The answer to one whole telegram of function 3, 16 or 23 on live blocks; None for anything else."""
    if len(telegram) < 12 or telegram[7] not in (READ, WRITE, BOTH) or telegram[2:4] != b"\0\0":
        return None
    if int.from_bytes(telegram[4:6], "big") != len(telegram) - 6:
        return None
    order = _order(telegram[7:], live)
    if order is None:
        return None
    function = telegram[7]
    try:
        body = _carry_out(order, blocks)
    except ObjectError:
        function, body = function | 0x80, bytes((ADDRESS,))
    except (ValueError, OverflowError):
        function, body = function | 0x80, bytes((VALUE,))
    return struct.pack(">2sHHBB", telegram[:2], 0, len(body) + 2, telegram[6], function) + body


#: block and first register to write, values; block, first register and count to read; the head of a write's answer
_Order = tuple[tuple[int, int, list[int]] | None, tuple[int, int, int] | None, bytes]


def _order(pdu: bytes, live: tuple[int, ...]) -> _Order | None:
    written, read, rest = None, None, pdu[1:]
    if pdu[0] in (READ, BOTH):
        address, count = struct.unpack_from(">HH", rest)
        read, rest = _place(address, count, live, MOST_READ), rest[4:]
        if read is None:
            return None
    if pdu[0] in (WRITE, BOTH):
        if len(rest) < 5:
            return None
        address, count, size = struct.unpack_from(">HHB", rest)
        place = _place(address, count, live, MOST_WRITTEN)
        if place is None or size != 2 * count or len(rest) != 5 + size:
            return None
        written = place[0], place[1], list(struct.unpack_from(f">{count}H", rest, 5))
    elif rest:
        return None
    return written, read, pdu[1:5]


def _place(address: int, count: int, live: tuple[int, ...], most: int) -> tuple[int, int, int] | None:
    for base in live:
        if base <= address and address + count <= base + BLOCK and 0 < count <= most:
            return base, address - base, count
    return None


def _carry_out(order: _Order, blocks: Blocks) -> bytes:
    written, read, head = order
    if written is not None:
        blocks.write_block(*written)
    if read is None:
        return head
    base, first, count = read
    values = (blocks.read_block(base) or [])[first : first + count]
    return struct.pack(f">B{count}H", 2 * count, *values)
