"""Function 43 / MEI 13, CANopen general reference (igus dryve D1, Nanotec): any object over Modbus."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pymodbus.constants import ExcCodes
from pymodbus.pdu import ExceptionResponse, ModbusPDU

MEI = 0x0D
Access = Callable[[int, int, bytes | None, int], bytes]


class ObjectError(Exception):
    """The drive refuses an object: no such one, read only, or a length that is not its own."""


class ObjectReply(ModbusPDU):
    """2B 0D rw 00 00 index sub 00 00 00 n data, data little endian."""

    function_code = 0x2B

    def __init__(self, head: bytes = b"", data: bytes = b"", **known: Any) -> None:
        super().__init__(**known)
        self.head, self.data = head, data

    def encode(self) -> bytes:
        """The telegram after the function code."""
        return self.head[:10] + bytes((len(self.data),)) + self.data


class ObjectRequest(ModbusPDU):
    """A read (rw = 0) or write (rw = 1) of one object; a class per drive, see `request_for`."""

    function_code = 0x2B
    access: Access

    def __init__(self, **known: Any) -> None:
        super().__init__(**known)
        self.body = b""

    @classmethod
    def decode_sub_function_code(cls, data: bytes) -> int:
        """-1 for MEI 13, which is this class's own; else the MEI type."""
        return -1 if len(data) < 3 or data[2] == MEI else int(data[2])

    @classmethod
    def calculateRtuFrameSize(cls, data: bytes) -> int:
        """Bytes of the whole telegram with address and check; 0 where more are needed to tell."""
        if len(data) < 13:
            return 0
        return 15 + (data[12] if data[3] == 1 else 0)

    def decode(self, data: bytes) -> None:
        """The telegram after the function code."""
        self.sub_function_code = data[0]
        self.body = bytes(data)

    async def datastore_update(self, context: Any, device_id: int) -> ModbusPDU:
        """Carry it out; exceptions 2 (no such object) and 3 (malformed)."""
        body = self.body
        if len(body) < 11 or body[1] > 1 or (body[1] == 1 and len(body) != 11 + body[10]):
            return ExceptionResponse(self.function_code, ExcCodes.ILLEGAL_VALUE)
        index, sub = int.from_bytes(body[4:6], "big"), body[6]
        try:
            data = type(self).access(index, sub, body[11:] if body[1] else None, body[10])
        except ObjectError:
            return ExceptionResponse(self.function_code, ExcCodes.ILLEGAL_ADDRESS)
        return ObjectReply(body, data, dev_id=device_id, transaction_id=self.transaction_id)


def request_for(access: Access) -> type[ObjectRequest]:
    """The request class for one drive: access(index, sub, data to write or None, length asked) -> data read."""

    class Bound(ObjectRequest):
        pass

    Bound.access = staticmethod(access)
    return Bound
