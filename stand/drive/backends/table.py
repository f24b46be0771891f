"""Each value in registers of its own, as the profile lists them under [quantities] (LXM32M, Festo, IAI, ORCA)."""

from __future__ import annotations

from collections.abc import Mapping

from stand.drive.address import check_width
from stand.drive.profile import DriveProfile, Quantity
from stand.errors import DeviceError
from stand.transport import modbus
from stand.transport.link import ModbusLink

SNAPSHOT = ("statusword", "position", "velocity", "error_code")


class Table:
    """The `table` back-end."""

    def __init__(self, profile: DriveProfile, link: ModbusLink) -> None:
        self.profile, self.link = profile, link
        self._order = profile.encoding.word_order

    def setup(self) -> list[str]:
        """Nothing to set up."""
        return []

    def has(self, name: str) -> bool:
        """Whether [quantities] lists it."""
        return name in self.profile.quantities

    def _quantity(self, name: str) -> Quantity:
        if not self.has(name):
            remedy = "Add it to [quantities]"
            raise DeviceError(f"no register for {name!r}", where=self.profile.profile.name, remedy=remedy)
        return self.profile.quantities[name]

    def read(self, name: str) -> int:
        """One value."""
        quantity = self._quantity(name)
        bits = int(quantity.type[1:])
        answer = self.link.transact(modbus.read_registers(quantity.reg, bits // 16, quantity.fc))
        return modbus.number(modbus.registers(answer), bits, quantity.type[0] == "i", self._order)

    def write(self, name: str, value: int) -> None:
        """One value."""
        self.link.transact(self._write(name, value))

    def _write(self, name: str, value: int) -> bytes:
        quantity = self._quantity(name)
        bits = int(quantity.type[1:])
        check_width(value, bits, quantity.type[0] == "i", f"register {quantity.reg}")
        return modbus.write_registers(quantity.reg, modbus.words(value & ((1 << bits) - 1), bits, self._order))

    def snapshot(self) -> Mapping[str, int]:
        """Status, position, velocity, error: one request each."""
        return {name: self.read(name) for name in SNAPSHOT if self.has(name)}

    def command(self, values: Mapping[str, int]) -> Mapping[str, int]:
        """One write each, the controlword last."""
        for name in sorted(values, key=lambda n: n == "controlword"):
            self.write(name, values[name])
        return self.snapshot()

    def quick_stop(self, value: int) -> bytes:
        """The request that writes the controlword."""
        return self._write("controlword", value)


def make(profile: DriveProfile, link: ModbusLink) -> Table:
    """The back-end on a link."""
    return Table(profile, link)
