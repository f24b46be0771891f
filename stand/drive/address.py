"""Where a drive keeps a value: a CANopen object or a register, with its width and sign."""

from __future__ import annotations

import re
from dataclasses import dataclass

from stand.errors import InputError

_OBJECT = re.compile(r"^(?P<index>[0-9A-Fa-f]{4}):(?P<sub>[0-9A-Fa-f]+)/(?P<type>[ui]?)(?P<bits>8|16|32)$")


@dataclass(frozen=True, slots=True)
class Address:
    """Object index and subindex, bits, and whether the value is signed."""

    index: int
    sub: int
    bits: int
    signed: bool

    @property
    def mapping(self) -> int:
        """The 32-bit mapping entry: index, subindex, bit length."""
        return self.index << 16 | self.sub << 8 | self.bits

    def decode(self, data: bytes) -> int:
        """From little-endian object data."""
        return int.from_bytes(data[: self.bits // 8], "little", signed=self.signed)

    def encode(self, value: int) -> bytes:
        """To little-endian object data; InputError where it doesn't fit."""
        check_width(value, self.bits, self.signed, str(self))
        return (value & ((1 << self.bits) - 1)).to_bytes(self.bits // 8, "little")

    def __str__(self) -> str:
        return f"{self.index:04X}:{self.sub:02X}"


def check_width(value: int, bits: int, signed: bool, where: str) -> None:
    """InputError where `value` doesn't fit the object: nothing is clipped."""
    low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
    if not low <= value <= high:
        raise InputError(f"does not fit {bits} bits", where=where, value=value, remedy=f"Stay in {low}..{high}")


def parse_address(text: str, where: str = "") -> Address:
    """ "6064:0/i32"; a width without a letter is unsigned."""
    match = _OBJECT.match(text)
    if match is None:
        raise InputError("not an object address", where=where, value=text, remedy='Write it like "6064:0/i32"')
    return Address(int(match["index"], 16), int(match["sub"], 16), int(match["bits"]), match["type"] == "i")


#: CiA 402 objects by the names that the driver uses; a profile may move, add or remove some
CIA402 = {
    "controlword": "6040:0/u16",
    "statusword": "6041:0/u16",
    "error_code": "603F:0/u16",
    "quick_stop_option": "605A:0/i16",
    "mode": "6060:0/i8",
    "mode_display": "6061:0/i8",
    "position": "6064:0/i32",
    "following_window": "6065:0/u32",
    "velocity": "606C:0/i32",
    "target_position": "607A:0/i32",
    "limit_low": "607D:1/i32",
    "limit_high": "607D:2/i32",
    "profile_velocity": "6081:0/u32",
    "profile_acceleration": "6083:0/u32",
    "profile_deceleration": "6084:0/u32",
    "quick_stop_deceleration": "6085:0/u32",
    "homing_method": "6098:0/i8",
    "following_error": "60F4:0/i32",
    "digital_inputs": "60FD:0/u32",
    "target_velocity": "60FF:0/i32",
    "vendor_id": "1018:1/u32",
    "product_code": "1018:2/u32",
    "revision": "1018:3/u32",
    "serial_number": "1018:4/u32",
}
