"""Modbus telegrams, sans-IO: requests and answers as bytes, on TCP and on RTU (Modbus Application Protocol V1.1b3)."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stand.errors import DeviceError

READ_HOLDING, READ_INPUT, WRITE_ONE, WRITE_MANY, READ_WRITE, ENCAPSULATED = 3, 4, 6, 16, 23, 43
CANOPEN = 13
_EXCEPTIONS = {
    1: "illegal function",
    2: "illegal data address",
    3: "illegal data value",
    4: "device failure",
    5: "acknowledge only",
    6: "device busy",
}


def read_registers(address: int, count: int, function: int = READ_HOLDING) -> bytes:
    """FC 3 or 4."""
    return struct.pack(">BHH", function, address, count)


def write_register(address: int, value: int) -> bytes:
    """FC 6."""
    return struct.pack(">BHH", WRITE_ONE, address, value)


def write_registers(address: int, values: Sequence[int]) -> bytes:
    """FC 16."""
    n = len(values)
    return struct.pack(f">BHHB{n}H", WRITE_MANY, address, n, 2 * n, *values)


def exchange_registers(read: int, count: int, write: int, values: Sequence[int]) -> bytes:
    """FC 23: the write is done before the read."""
    n = len(values)
    return struct.pack(f">BHHHHB{n}H", READ_WRITE, read, count, write, n, 2 * n, *values)


def read_object(index: int, sub: int, size: int) -> bytes:
    """FC 43/13: an object of `size` bytes."""
    return struct.pack(">BBBHHBHBB", ENCAPSULATED, CANOPEN, 0, 0, index, sub, 0, 0, size)


def write_object(index: int, sub: int, data: bytes) -> bytes:
    """FC 43/13: `data` little-endian."""
    return struct.pack(">BBBHHBHBB", ENCAPSULATED, CANOPEN, 1, 0, index, sub, 0, 0, len(data)) + data


def registers(answer: bytes) -> tuple[int, ...]:
    """The registers in the answer to FC 3, 4 or 23."""
    return struct.unpack_from(f">{answer[1] // 2}H", answer, 2)


def object_data(answer: bytes) -> bytes:
    """The little-endian data in the answer to FC 43/13."""
    return answer[12 : 12 + answer[11]]


def check_answer(request: bytes, answer: bytes, where: str) -> bytes:
    """The answer itself; DeviceError where it is an exception or does not belong to the request."""
    if answer[:1] == request[:1]:
        return answer
    if answer and answer[0] == request[0] | 0x80:
        word = _EXCEPTIONS.get(answer[1], f"exception {answer[1]}")
        raise DeviceError(f"the device refused function {request[0]}: {word}", where=where, value=request.hex())
    raise DeviceError("an answer to another question", where=where, value=answer.hex(), remedy="Check the link")


@dataclass(frozen=True, slots=True)
class TcpFraming:
    """MBAP header: transaction, protocol 0, length, unit."""

    unit: int

    def wrap(self, pdu: bytes, transaction: int = 0) -> bytes:
        """The whole telegram."""
        return struct.pack(">HHHB", transaction & 0xFFFF, 0, len(pdu) + 1, self.unit) + pdu

    def missing(self, received: bytes) -> int:
        """Bytes still to come, at least."""
        return 8 - len(received) if len(received) < 8 else 6 + int.from_bytes(received[4:6], "big") - len(received)

    def unwrap(self, telegram: bytes) -> bytes:
        """What the telegram carries."""
        return telegram[7:]


@dataclass(frozen=True, slots=True)
class RtuFraming:
    """Unit address, PDU, CRC-16 low byte first."""

    unit: int

    def wrap(self, pdu: bytes, transaction: int = 0) -> bytes:
        """The whole telegram."""
        body = bytes((self.unit,)) + pdu
        return body + struct.pack("<H", crc16(body))

    def missing(self, received: bytes) -> int:
        """Bytes still to come, at least."""
        if len(received) < 5:
            return 5 - len(received)
        return _rtu_length(received) - len(received)

    def unwrap(self, telegram: bytes) -> bytes:
        """What the telegram carries; DeviceError on a wrong checksum."""
        if crc16(telegram[:-2]) != int.from_bytes(telegram[-2:], "little"):
            raise DeviceError("wrong checksum", value=telegram.hex(), remedy="Check baud, parity and termination")
        return telegram[1:-2]


def _rtu_length(received: bytes) -> int:
    function = received[1]
    if function & 0x80:
        return 5
    if function in (WRITE_ONE, WRITE_MANY):
        return 8
    if function == ENCAPSULATED:
        return 15 + received[12] if len(received) > 12 else 15
    return 5 + received[2]


def _crc_table() -> tuple[int, ...]:
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = (byte >> 1) ^ 0xA001 if byte & 1 else byte >> 1
        table.append(byte)
    return tuple(table)


_TABLE = _crc_table()


def crc16(data: bytes) -> int:
    """CRC-16/MODBUS."""
    crc = 0xFFFF
    for byte in data:
        crc = (crc >> 8) ^ _TABLE[(crc ^ byte) & 0xFF]
    return crc


def words(value: int, bits: int, order: str) -> list[int]:
    """An integer as registers, high word first where order is "big"."""
    count = max(1, bits // 16)
    parts = [(value >> (16 * i)) & 0xFFFF for i in range(count)]
    return parts[::-1] if order == "big" else parts


def number(parts: Sequence[int], bits: int, signed: bool, order: str) -> int:
    """Registers as an integer of `bits` bits."""
    ordered = parts if order == "big" else list(parts)[::-1]
    value = 0
    for part in ordered:
        value = value << 16 | int(part)
    value &= (1 << bits) - 1
    return value - (1 << bits) if signed and value >> (bits - 1) else value


def register_array(answer: bytes) -> np.ndarray:
    """The registers in the answer to FC 3 as uint16 [n]."""
    return np.frombuffer(answer, ">u2", offset=2, count=answer[1] // 2).astype(np.uint16)
