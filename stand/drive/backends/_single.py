"""What the back-ends that reach one value at a time have in common; they differ in where a value is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from pymodbus.pdu import ModbusPDU

from stand.drive.address import check_width
from stand.drive.profile import DriveProfile
from stand.errors import DeviceError
from stand.transport import modbus
from stand.transport.link import ModbusLink

SNAPSHOT = ("statusword", "position", "velocity", "error_code")


@dataclass(frozen=True, slots=True)
class Place:
    """One value on the wire: the question for it, the value in its answer, and the request that writes it."""

    ask: ModbusPDU
    decode: Callable[[ModbusPDU], int]
    write: Callable[[int], ModbusPDU]


@dataclass(frozen=True)
class SingleValues:
    """A back-end that reads and writes value by value. find: the place of a name, None where there is none."""

    profile: DriveProfile
    link: ModbusLink
    find: Callable[[str], Place | None]
    remedy: str

    def setup(self) -> list[str]:
        """Nothing to set up."""
        return []

    def has(self, name: str) -> bool:
        """Whether the profile says where the value is."""
        return self.find(name) is not None

    def _place(self, name: str) -> Place:
        found = self.find(name)
        if found is None:
            raise DeviceError(f"keeps no {name!r}", where=self.profile.profile.name, remedy=self.remedy)
        return found

    def read(self, name: str) -> int:
        """One value."""
        place = self._place(name)
        return place.decode(self.link.transact(place.ask))

    def write(self, name: str, value: int) -> None:
        """One value."""
        self.link.transact(self._place(name).write(value))

    def snapshot(self) -> Mapping[str, int]:
        """Status, position, velocity, error: one request each."""
        return {name: self.read(name) for name in SNAPSHOT if self.has(name)}

    def command(self, values: Mapping[str, int]) -> Mapping[str, int]:
        """One write each, the controlword last."""
        for name in sorted(values, key=lambda n: n == "controlword"):
            self.write(name, values[name])
        return self.snapshot()

    def quick_stop(self, value: int) -> ModbusPDU:
        """The request that writes the controlword."""
        return self._place("controlword").write(value)


def register_place(register: int, bits: int, signed: bool, order: str, function: int = 3) -> Place:
    """A value of 8 (in the low byte), 16 or 32 bits in registers of its own."""

    def decode(answer: ModbusPDU) -> int:
        return modbus.number(modbus.registers(answer), bits, signed, order)

    def write(value: int) -> ModbusPDU:
        check_width(value, bits, signed, f"register {register:#06x}")
        return modbus.write_registers(register, modbus.words(value & ((1 << bits) - 1), bits, order))

    return Place(modbus.read_registers(register, max(1, bits // 16), function), decode, write)
