"""The drive's object dictionary and its process images (Nanotec, bus/modbus/pdo.html)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from mocks.wire.canopen import ObjectError

KINDS = {"u8": (1, False), "i8": (1, True), "u16": (2, False), "i16": (2, True), "u32": (4, False), "i32": (4, True)}
DUMMIES = {0x0002: 1, 0x0003: 2, 0x0004: 4, 0x0005: 1, 0x0006: 2, 0x0007: 4}


@dataclass(slots=True)
class Entry:
    """One object: kind, present value; read gives a live value, write takes a new one (None: read only)."""

    kind: str
    value: int = 0
    read: Callable[[], int] | None = None
    write: Callable[[int], None] | None = None
    writable: bool = False

    @property
    def size(self) -> int:
        """Bytes."""
        return KINDS[self.kind][0]

    def get(self) -> int:
        """Its value now."""
        return self.read() if self.read else self.value

    def put(self, value: int) -> None:
        """A new value; ObjectError where it is read only."""
        if not self.writable:
            raise ObjectError("read only")
        self.value = value
        if self.write:
            self.write(value)

    def encode(self, order: str) -> bytes:
        """Its bytes, `order` big or little."""
        mask = (1 << 8 * self.size) - 1
        return (self.get() & mask).to_bytes(self.size, order)  # type: ignore[arg-type]

    def decode(self, data: bytes, order: str) -> int:
        """The value that bytes stand for."""
        return int.from_bytes(data, order, signed=KINDS[self.kind][1])  # type: ignore[arg-type]


class Dictionary:
    """Objects by index and subindex; images at their registers."""

    def __init__(self, word_order: str = "big", byte_order: str = "big") -> None:
        self.word_order, self.byte_order = word_order, byte_order
        self.entries: dict[tuple[int, int], Entry] = {}

    def add(self, index: int, kind: str, value: int = 0, sub: int = 0, *, writable: bool = True) -> Entry:
        """A new object that keeps its value."""
        entry = self.entries[index, sub] = Entry(kind, value, writable=writable)
        return entry

    def live(self, index: int, kind: str, read: Callable[[], int], sub: int = 0) -> None:
        """A new object that is read only and told by a function."""
        self.entries[index, sub] = Entry(kind, read=read)

    def on_write(self, index: int, act: Callable[[int], None], sub: int = 0) -> None:
        """What a write to an object sets off."""
        self.entries[index, sub].write = act

    def find(self, index: int, sub: int) -> Entry:
        """The object; ObjectError where there is none."""
        if (index, sub) not in self.entries:
            raise ObjectError(f"no object {index:04X}:{sub}")
        return self.entries[index, sub]

    def __getitem__(self, index: int) -> int:
        return self.entries[index, 0].get()

    def access(self, index: int, sub: int, data: bytes | None, length: int) -> bytes:
        """Function 43/13: little endian; ObjectError for a wrong object or length."""
        entry = self.find(index, sub)
        if data is None:
            return entry.encode("little")
        if len(data) != entry.size:
            raise ObjectError(f"{index:04X}:{sub} has {entry.size} bytes, not {len(data)}")
        entry.put(entry.decode(data, "little"))
        return b""

    def add_mapping(self, index: int, mapping: list[int]) -> None:
        """A mapping object: sub 0 the number of entries, 16 entries."""
        self.add(index, "u8", len(mapping))
        for sub in range(1, 17):
            self.add(index, "u32", mapping[sub - 1] if sub <= len(mapping) else 0, sub)
        self.on_write(index, lambda count: self._check_mapping(index, count))

    def _check_mapping(self, index: int, count: int) -> None:
        if count > 16:
            raise ObjectError("16 entries at most")
        for sub in range(1, count + 1):
            self._mapped(self.entries[index, sub].value)

    def _mapped(self, entry: int) -> tuple[Entry | None, int]:
        number, sub, bits = entry >> 16, entry >> 8 & 0xFF, entry & 0xFF
        if number in DUMMIES:
            return None, bits // 8
        found = self.find(number, sub)
        if found.size * 8 != bits:
            raise ObjectError(f"{number:04X}:{sub} has {8 * found.size} bits, not {bits}")
        return found, bits // 8

    def layout(self, index: int) -> list[tuple[Entry | None, int]]:
        """(object or None for a dummy, byte offset) in the order of the image."""
        found, offset = [], 0
        for sub in range(1, self[index] + 1):
            entry, size = self._mapped(self.entries[index, sub].value)
            found.append((entry, offset))
            offset += size
        return found

    def image(self, index: int) -> list[int]:
        """The 64 registers of an image, zero after its end."""
        data = bytearray(128)
        for entry, offset in self.layout(index):
            if entry:
                data[self._place(entry, offset)] = self._ordered(entry.encode("big"))
        return [data[i] << 8 | data[i + 1] for i in range(0, 128, 2)]

    def take_image(self, index: int, first: int, values: list[int]) -> list[tuple[Entry, int]]:
        """The objects that lie wholly in the registers written (from `first` in the image), with their new values."""
        data, start = b"".join(v.to_bytes(2, "big") for v in values), 2 * first
        found = []
        for entry, offset in self.layout(index):
            if entry is None:
                continue
            place = self._place(entry, offset)
            if place.start >= start and place.stop <= start + len(data):
                piece = self._ordered(data[place.start - start : place.stop - start])
                found.append((entry, entry.decode(piece, "big")))
        return found

    def _place(self, entry: Entry, offset: int) -> slice:
        if entry.size == 1 and self.byte_order == "little":
            offset ^= 1
        return slice(offset, offset + entry.size)

    def _ordered(self, data: bytes) -> bytes:
        return data[2:] + data[:2] if len(data) == 4 and self.word_order == "little" else data
