"""Each value in registers of its own, as the profile lists them under [quantities] (LXM32M, Festo, IAI, ORCA)."""

from __future__ import annotations

from stand.drive.backends._single import Place, SingleValues, register_place
from stand.drive.profile import DriveProfile
from stand.transport.link import ModbusLink


def make(profile: DriveProfile, link: ModbusLink) -> SingleValues:
    """The back-end on a link."""

    def find(name: str) -> Place | None:
        quantity = profile.quantities.get(name)
        if quantity is None:
            return None
        bits, signed = int(quantity.type[1:]), quantity.type[0] == "i"
        return register_place(quantity.reg, bits, signed, profile.encoding.word_order, quantity.fc)

    return SingleValues(profile, link, find, "Add it to [quantities]")
