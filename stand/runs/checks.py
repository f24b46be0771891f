"""What must be true of the stand before it moves."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from stand.drive.cia402 import State
from stand.errors import DeviceError, SafetyTrip

if TYPE_CHECKING:
    from stand.drive.drive import Drive
    from stand.runs.rig import Rig

AT_REST = 0.0005
SETTLE = 0.5
STANDING = 0.005


@dataclass(frozen=True, slots=True)
class RestCheck:
    """The force at rest against what the setup's weight and incline give, N; ok within the tolerance."""

    force: float
    expected: float
    tolerance: float

    @property
    def ok(self) -> bool:
        """True within the tolerance."""
        return abs(self.force - self.expected) <= self.tolerance


def identify(rig: Rig) -> dict[str, dict[str, str]]:
    """Every device's identity by its own word; the gauges are told to stream."""
    identities = {name: reader.identify() for name, reader in rig.readers.items()}
    found = {**rig.drive.identify(), "word_order": rig.drive.word_order}
    identities["drive"] = {**identities["drive"], **found}
    return identities


def check_state(rig: Rig) -> None:
    """DeviceError where the drive is in fault: a fault is looked at by a person before anything moves again."""
    status = rig.drive.status()
    if status.state is State.FAULT:
        remedy = "Find the cause, then reset the drive (preparation step `reset`)"
        value = f"error code {status.fault_code:#06x}"
        raise DeviceError("is in fault", where="drive", value=value, remedy=remedy)


def go_to_rest(rig: Rig, travel: float, *, move: bool, home: bool) -> None:
    """Home if ordered and go to `travel` m; without `move`, DeviceError where the drive isn't there."""
    if home:
        rig.drive.home(should_stop=rig.halt.wanted)
    if move:
        rig.drive.move_to(travel, should_stop=rig.halt.wanted)
        rig.halt.wait(SETTLE)
    if rig.halt.wanted():
        raise SafetyTrip("stopped while preparing", where="drive", value=rig.halt.reason)
    found = rig.drive.status().travel
    if abs(found - travel) > AT_REST:
        remedy = f"Move it to {travel * 1e3:g} mm"
        raise DeviceError("is not at its rest position", where="drive", value=found, remedy=remedy)


def await_standstill(drive: Drive, timeout: float = 1.0) -> None:
    """Until the drive says that it stands; DeviceError where it doesn't."""
    deadline = time.monotonic() + timeout
    while abs(velocity := drive.status().velocity) > STANDING:
        if time.monotonic() > deadline:
            raise DeviceError("still moves", where="drive", value=f"{velocity:.4f} m/s", remedy="Cut its power")
        time.sleep(0.01)


def rest_force(rig: Rig) -> RestCheck:
    """The mean force over the last 0.4 s beside the setup's m g sin(alpha)."""
    force = float(rig.acquisition.meters["force_gauge"].recent().mean())
    return RestCheck(force, rig.stand.setup.rest_tension, rig.stand.limits.rest_force_tolerance)


def check_rest_force(rig: Rig) -> RestCheck:
    """The rest force; DeviceError where it is not what the setup's mass and incline give."""
    found = rest_force(rig)
    if not found.ok:
        what = f"the rest force is {found.force:.2f} N, the setup gives {found.expected:.2f} +- {found.tolerance:.2f} N"
        remedy = "Check the mounted mass, the fibre and the gauge's zero (tare it without load), or mend the setup"
        raise DeviceError(what, where="force_gauge", remedy=remedy)
    return found
