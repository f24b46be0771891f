"""A process image: values packed one after another into registers, sans-IO (Nanotec, bus/modbus/pdo.html)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from stand.drive.address import Address, check_width, parse_address
from stand.errors import InputError

#: dummies 0005h (u8), 0006h (u16) fill the image
_PADS = {"pad8": Address(0x0005, 0, 8, False), "pad16": Address(0x0006, 0, 16, False)}


@dataclass(frozen=True)
class ImageLayout:
    """entries: (name or "", address) in the image's order; word_order of 32-bit, byte_order of 8-bit values."""

    entries: tuple[tuple[str, Address], ...]
    word_order: str
    byte_order: str

    @property
    def size(self) -> int:
        """Registers."""
        return (sum(address.bits for _, address in self.entries) + 15) // 16

    @property
    def names(self) -> frozenset[str]:
        """What the image holds."""
        return frozenset(name for name, _ in self.entries if name)

    def reordered(self, word_order: str, byte_order: str) -> ImageLayout:
        """The same image with other orders."""
        return replace(self, word_order=word_order, byte_order=byte_order)

    def unpack(self, registers: Sequence[int]) -> dict[str, int]:
        """Values by name, signed where they are."""
        data, offset, values = self._swap(registers), 0, {}
        for name, address in self.entries:
            size = address.bits // 8
            if name:
                values[name] = self._value(data[offset : offset + size], address)
            offset += size
        return values

    def pack(self, values: Mapping[str, int]) -> list[int]:
        """Registers; what is not named is zero."""
        data = b"".join(self._bytes(values.get(name, 0), address, name) for name, address in self.entries)
        data += b"\0" * (len(data) % 2)
        registers = [int.from_bytes(data[i : i + 2], "big") for i in range(0, len(data), 2)]
        swapped = self._swap(registers)
        return [int.from_bytes(swapped[i : i + 2], "big") for i in range(0, len(swapped), 2)]

    def _swap(self, registers: Sequence[int]) -> bytes:
        """Bytes of the image, with those registers that hold two 8-bit values in reading order."""
        data = bytearray(b"".join(int(r).to_bytes(2, "big") for r in registers))
        if self.byte_order == "little":
            for start in self._byte_pairs():
                data[start : start + 2] = data[start : start + 2][::-1]
        return bytes(data)

    def _byte_pairs(self) -> list[int]:
        offset, found = 0, []
        for _, address in self.entries:
            if address.bits == 8 and offset % 2 == 0:
                found.append(offset)
            offset += address.bits // 8
        return found

    def _value(self, data: bytes, address: Address) -> int:
        if address.bits == 32 and self.word_order == "little":
            data = data[2:] + data[:2]
        return int.from_bytes(data, "big", signed=address.signed)

    def _bytes(self, value: int, address: Address, name: str) -> bytes:
        check_width(value, address.bits, address.signed, name)
        data = (value & ((1 << address.bits) - 1)).to_bytes(address.bits // 8, "big")
        return data[2:] + data[:2] if address.bits == 32 and self.word_order == "little" else data


def parse_layout(
    entries: Sequence[str], addresses: Mapping[str, Address], word_order: str, byte_order: str, where: str
) -> ImageLayout:
    """The layout that a profile's map lists; InputError where 16- or 32-bit values would straddle registers."""
    names = {(a.index, a.sub): name for name, a in addresses.items()}
    found: list[tuple[str, Address]] = []
    offset = 0
    for text in entries:
        address = _PADS.get(text) or parse_address(text, where)
        if address.bits > 8 and offset % 16:
            raise InputError("does not begin at a register", where=where, value=text, remedy="Put pad8 before it")
        name = names.get((address.index, address.sub), "")
        known = addresses.get(name)
        found.append((name, known if known is not None and known.bits == address.bits else address))
        offset += address.bits
    return ImageLayout(tuple(found), word_order, byte_order)
