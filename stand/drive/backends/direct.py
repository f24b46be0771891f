"""The register address is the object's index (Mitsubishi MR-JE-C)."""

from __future__ import annotations

from collections.abc import Mapping

from stand.drive.address import Address, check_width
from stand.drive.profile import DriveProfile
from stand.errors import DeviceError
from stand.transport import modbus
from stand.transport.link import ModbusLink

SNAPSHOT = ("statusword", "position", "velocity", "error_code")


class Direct:
    """The `direct` back-end: plain objects only, no subindices; an 8-bit value sits in the low byte."""

    def __init__(self, profile: DriveProfile, link: ModbusLink) -> None:
        self.profile, self.link = profile, link
        self._order = profile.encoding.word_order

    def setup(self) -> list[str]:
        """Nothing to set up."""
        return []

    def has(self, name: str) -> bool:
        """Whether the object can be addressed by its index alone."""
        address = self.profile.addresses.get(name)
        return address is not None and address.sub == 0

    def _address(self, name: str) -> Address:
        if not self.has(name):
            raise DeviceError(f"no register for {name!r}", where=self.profile.profile.name, remedy="See the profile")
        return self.profile.addresses[name]

    def read(self, name: str) -> int:
        """One object."""
        address = self._address(name)
        count = max(1, address.bits // 16)
        answer = self.link.transact(modbus.read_registers(address.index, count))
        return modbus.number(modbus.registers(answer), address.bits, address.signed, self._order)

    def write(self, name: str, value: int) -> None:
        """One object."""
        self.link.transact(self._write(name, value))

    def _write(self, name: str, value: int) -> bytes:
        address = self._address(name)
        check_width(value, address.bits, address.signed, str(address))
        raw = value & ((1 << address.bits) - 1)
        return modbus.write_registers(address.index, modbus.words(raw, address.bits, self._order))

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


def make(profile: DriveProfile, link: ModbusLink) -> Direct:
    """The back-end on a link."""
    return Direct(profile, link)
