"""Every object through function 43/13, CANopen general reference (igus dryve D1; Nanotec data access)."""

from __future__ import annotations

from collections.abc import Mapping

from stand.drive.address import Address
from stand.drive.profile import DriveProfile
from stand.errors import DeviceError
from stand.transport import modbus
from stand.transport.link import ModbusLink

SNAPSHOT = ("statusword", "position", "velocity", "error_code")


class Mei13:
    """The `mei13` back-end."""

    def __init__(self, profile: DriveProfile, link: ModbusLink) -> None:
        self.profile, self.link = profile, link

    def setup(self) -> list[str]:
        """Nothing to set up."""
        return []

    def has(self, name: str) -> bool:
        """Whether the profile knows the object."""
        return name in self.profile.addresses

    def address(self, name: str) -> Address:
        """The object of that name; DeviceError where the profile has none."""
        if not self.has(name):
            raise DeviceError(
                f"no object for {name!r}", where=self.profile.profile.name, remedy="Add it to the profile"
            )
        return self.profile.addresses[name]

    def read(self, name: str) -> int:
        """One object."""
        return self.read_object(self.address(name))

    def read_object(self, address: Address) -> int:
        """One object by its address."""
        answer = self.link.transact(modbus.read_object(address.index, address.sub, address.bits // 8))
        return address.decode(modbus.object_data(answer))

    def write(self, name: str, value: int) -> None:
        """One object."""
        self.write_object(self.address(name), value)

    def write_object(self, address: Address, value: int) -> None:
        """One object by its address."""
        self.link.transact(modbus.write_object(address.index, address.sub, address.encode(value)))

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
        address = self.address("controlword")
        return modbus.write_object(address.index, address.sub, address.encode(value))


def make(profile: DriveProfile, link: ModbusLink) -> Mei13:
    """The back-end on a link."""
    return Mei13(profile, link)
