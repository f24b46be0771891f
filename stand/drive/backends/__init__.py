"""Addressing back-ends, one a file: how a drive's values are read and written by the driver's names."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Protocol

from pymodbus.pdu import ModbusPDU

from stand.drive.profile import DriveProfile
from stand.transport.link import ModbusLink


class Backend(Protocol):
    """Values by name, in the drive's own counts."""

    def setup(self) -> list[str]:
        """Configure and probe; what was found, in words."""

    def has(self, name: str) -> bool:
        """Whether the drive keeps that value where this back-end reaches it."""

    def read(self, name: str) -> int:
        """One value; DeviceError where it can't be had."""

    def write(self, name: str, value: int) -> None:
        """One value."""

    def snapshot(self) -> Mapping[str, int]:
        """What one request brings of statusword, position, velocity and the like."""

    def command(self, values: Mapping[str, int]) -> Mapping[str, int]:
        """Write several values at once where the drive can, and take a snapshot."""

    def quick_stop(self, value: int) -> ModbusPDU:
        """The request that writes the controlword `value`."""


def make_backend(profile: DriveProfile, link: ModbusLink) -> Backend:
    """The back-end that the profile names, from the file of that name."""
    module = importlib.import_module(f"stand.drive.backends.{profile.encoding.backend}")
    backend: Backend = module.make(profile, link)
    return backend
