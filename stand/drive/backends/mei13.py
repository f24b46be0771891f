"""Every object through function 43/13, CANopen general reference (igus dryve D1; Nanotec data access)."""

from __future__ import annotations

from pymodbus.pdu import ModbusPDU

from stand.drive.address import Address
from stand.drive.backends._single import Place, SingleValues
from stand.drive.profile import DriveProfile
from stand.transport import modbus
from stand.transport.link import ModbusLink


def object_place(address: Address) -> Place:
    """An object by its address."""

    def decode(answer: ModbusPDU) -> int:
        return address.decode(modbus.object_data(answer))

    def write(value: int) -> ModbusPDU:
        return modbus.write_object(address.index, address.sub, address.encode(value))

    return Place(modbus.read_object(address.index, address.sub, address.bits // 8), decode, write)


def make(profile: DriveProfile, link: ModbusLink) -> SingleValues:
    """The back-end on a link."""

    def find(name: str) -> Place | None:
        address = profile.addresses.get(name)
        return None if address is None else object_place(address)

    return SingleValues(profile, link, find, "Add it to [objects] of the profile")
