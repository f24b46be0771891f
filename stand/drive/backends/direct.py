"""The register address is the object's index (Mitsubishi MR-JE-C): plain objects only, no subindices."""

from __future__ import annotations

from stand.drive.backends._single import Place, SingleValues, register_place
from stand.drive.profile import DriveProfile
from stand.transport.link import ModbusLink


def make(profile: DriveProfile, link: ModbusLink) -> SingleValues:
    """The back-end on a link."""

    def find(name: str) -> Place | None:
        address = profile.addresses.get(name)
        if address is None or address.sub:
            return None
        return register_place(address.index, address.bits, address.signed, profile.encoding.word_order)

    return SingleValues(profile, link, find, "Only objects without a subindex can be reached; see the profile")
