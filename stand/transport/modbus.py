"""Modbus questions and answers as pymodbus has them, function 43/13 beside them, and values out of registers."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pymodbus.pdu import ModbusPDU
from pymodbus.pdu.register_message import (
    ReadHoldingRegistersRequest,
    ReadInputRegistersRequest,
    ReadWriteMultipleRegistersRequest,
    WriteMultipleRegistersRequest,
    WriteSingleRegisterRequest,
)

from stand.errors import DeviceError

READ_WRITE = 23
CANOPEN = 13
_EXCEPTIONS = {
    1: "illegal function",
    2: "illegal data address",
    3: "illegal data value",
    4: "device failure",
    5: "acknowledge only",
    6: "device busy",
}


class ObjectRequest(ModbusPDU):
    """FC 43/13, CANopen general reference: an object read (`data` None) or written (`data` little-endian)."""

    function_code = 0x2B

    def __init__(self, index: int = 0, sub: int = 0, size: int = 0, data: bytes | None = None) -> None:
        super().__init__()
        self.index, self.sub, self.size, self.data = index, sub, size, data

    def encode(self) -> bytes:
        """What follows the function code."""
        write = self.data is not None
        head = struct.pack(">BBHHBHBB", CANOPEN, write, 0, self.index, self.sub, 0, 0, self.size)
        return head + (self.data or b"")


class ObjectAnswer(ModbusPDU):
    """The answer to it; `data` is little-endian."""

    function_code = 0x2B

    def __init__(self, **known: Any) -> None:
        super().__init__(**known)
        self.data = b""

    @classmethod
    def decode_sub_function_code(cls, data: bytes) -> int:
        """-1 for MEI 13, which is this class's own; else the MEI type."""
        return -1 if len(data) < 3 or data[2] == CANOPEN else int(data[2])

    @classmethod
    def calculateRtuFrameSize(cls, data: bytes) -> int:
        """Bytes of the whole telegram with address and check; 0 where more are needed to tell."""
        return 15 + data[12] if len(data) > 12 else 0

    def decode(self, data: bytes) -> None:
        """What follows the function code."""
        self.data = bytes(data[11 : 11 + data[10]])


def read_registers(address: int, count: int, function: int = 3) -> ModbusPDU:
    """FC 3 or 4."""
    kind = ReadInputRegistersRequest if function == 4 else ReadHoldingRegistersRequest
    return kind(address=address, count=count)


def write_register(address: int, value: int) -> ModbusPDU:
    """FC 6."""
    return WriteSingleRegisterRequest(address=address, registers=[value])


def write_registers(address: int, values: Sequence[int]) -> ModbusPDU:
    """FC 16."""
    return WriteMultipleRegistersRequest(address=address, registers=list(values))


def exchange_registers(read: int, count: int, write: int, values: Sequence[int]) -> ModbusPDU:
    """FC 23: the write is done before the read."""
    return ReadWriteMultipleRegistersRequest(
        read_address=read, read_count=count, write_address=write, write_registers=list(values)
    )


def read_object(index: int, sub: int, size: int) -> ModbusPDU:
    """FC 43/13: an object of `size` bytes."""
    return ObjectRequest(index, sub, size)


def write_object(index: int, sub: int, data: bytes) -> ModbusPDU:
    """FC 43/13: `data` little-endian."""
    return ObjectRequest(index, sub, len(data), data)


def registers(answer: ModbusPDU) -> Sequence[int]:
    """The registers in the answer to FC 3, 4 or 23."""
    return answer.registers


def register_array(answer: ModbusPDU) -> NDArray[np.uint16]:
    """The same as uint16 [n]."""
    return np.array(answer.registers, dtype=np.uint16)


def object_data(answer: ModbusPDU) -> bytes:
    """The little-endian data in the answer to FC 43/13; DeviceError where it is none."""
    if not isinstance(answer, ObjectAnswer):
        raise DeviceError("an answer to another question", value=str(answer), remedy="Check the link")
    return answer.data


def check_answer(request: ModbusPDU, answer: ModbusPDU, where: str) -> ModbusPDU:
    """The answer itself; DeviceError where it is an exception or does not belong to the request."""
    if answer.function_code == request.function_code:
        return answer
    if answer.function_code == request.function_code | 0x80:
        word = _EXCEPTIONS.get(answer.exception_code, f"exception {answer.exception_code}")
        remedy = "Check the profile's map against the drive's manual"
        raise DeviceError(f"the device refused {_told(request)}: {word}", where=where, remedy=remedy)
    raise DeviceError("an answer to another question", where=where, value=str(answer), remedy="Check the link")


def _told(request: ModbusPDU) -> str:
    at = f"object {request.index:04X}:{request.sub:02X}" if isinstance(request, ObjectRequest) else ""
    return f"function {request.function_code} at {at or f'register {request.address}'}"


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
