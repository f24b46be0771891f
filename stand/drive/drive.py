"""The drive in SI: states, homing, moves and planned motion over whatever back-end its profile names."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import TracebackType

from stand.config import DriveConfig, Limits, Stand
from stand.drive import cia402
from stand.drive.backends import make_backend
from stand.drive.cia402 import State
from stand.drive.profile import DriveProfile, QuantityName, load_profile
from stand.errors import DeviceError, InputError
from stand.transport.link import ModbusLink

_POLL = 0.005
QUANTITIES: tuple[QuantityName, ...] = ("position", "velocity", "acceleration")


@dataclass(frozen=True, slots=True)
class DriveStatus:
    """What the drive says of itself: travel m, velocity m/s; fault_code 0 where there is none."""

    state: State | None
    fault_code: int
    travel: float
    velocity: float
    homed: bool
    target_reached: bool
    internal_limit: bool


class Drive:
    """One drive on a link of its own. Calls block; none repeats a motion command by itself."""

    def __init__(
        self,
        config: DriveConfig,
        limits: Limits,
        *,
        profile: DriveProfile | None = None,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.config, self.limits = config, limits
        self.profile = profile or load_profile(config.profile)
        self.link = ModbusLink(config.link, clock)
        self.backend = make_backend(self.profile, self.link)
        self.clock, self.sleep = clock, sleep
        self.homed = False
        self.notes: list[str] = []
        units = self.profile.units
        self._scale: dict[str, float] = {q: units.si(q) for q in QUANTITIES}

    def __enter__(self) -> Drive:
        self.connect()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, tb: TracebackType | None) -> None:
        self.close()

    def connect(self) -> None:
        """Open the link, configure and probe the map, set the drive's own limits. Nothing moves."""
        self.link.open()
        self.notes = self.backend.setup()
        self.set_window(*self.limits.travel)
        self._write_if_kept("quick_stop_deceleration", self.counts("acceleration", self.limits.acceleration))

    def close(self) -> None:
        """Close the link; the drive stays in the state it is in."""
        self.link.close()

    def identify(self) -> dict[str, str]:
        """Identity as the drive states it, and what the probe found."""
        names = ("vendor_id", "product_code", "revision", "serial_number")
        found = {name: f"{self.backend.read(name):#x}" for name in names if self.backend.has(name)}
        return {"profile": self.profile.profile.name, **found, "encoding": "; ".join(self.notes)}

    @property
    def word_order(self) -> str:
        """The order of 32-bit values that the start-up probe found, or the profile's."""
        tx = getattr(self.backend, "tx", None)
        return str(tx.word_order) if tx is not None else self.profile.encoding.word_order

    def counts(self, quantity: str, value: float) -> int:
        """SI as the drive's counts, rounded to the nearest."""
        return round(value / self._scale[quantity])

    def travel_of(self, counts: int) -> float:
        """A position in counts as travel, m."""
        return self.config.direction * counts * self._scale["position"]

    def set_window(self, low: float, high: float) -> None:
        """The drive's own software limits, m of travel."""
        ends = sorted(self.counts("position", self.config.direction * end) for end in (low, high))
        self._write_if_kept("limit_low", ends[0])
        self._write_if_kept("limit_high", ends[1])

    def _write_if_kept(self, name: str, value: int) -> None:
        if self.backend.has(name):
            self.backend.write(name, value)

    def status(self) -> DriveStatus:
        """The drive's state now, from one snapshot."""
        return self.read_status(self.backend.snapshot())

    def read_status(self, snapshot: Mapping[str, int]) -> DriveStatus:
        """A snapshot in SI."""
        word = snapshot["statusword"]
        return DriveStatus(
            state=cia402.state_of(word),
            fault_code=snapshot.get("error_code", 0),
            travel=self.travel_of(snapshot["position"]),
            velocity=self.config.direction * snapshot.get("velocity", 0) * self._scale["velocity"],
            homed=self.homed,
            target_reached=bool(word & cia402.TARGET_REACHED),
            internal_limit=bool(word & cia402.INTERNAL_LIMIT),
        )

    def fault_reset(self) -> None:
        """Acknowledge a fault; DeviceError where it stays."""
        for word in cia402.fault_reset():
            self.backend.write("controlword", word)
        self._await(lambda s: s.state is not State.FAULT, "the fault does not clear", 1.0)

    def enable(self, mode: int = cia402.PROFILE_POSITION) -> None:
        """To operation enabled; DeviceError naming the fault where there is one."""
        self.set_mode(mode)
        deadline = self.clock() + 2.0
        while (status := self.status()).state is not State.ENABLED:
            if status.state is State.FAULT:
                raise self._fault(status)
            if self.clock() > deadline:
                raise DeviceError("does not enable", where=self.link.where, value=str(status.state))
            word = cia402.towards_enabled(status.state)
            if word is not None:
                self.backend.write("controlword", word)
            self.sleep(_POLL)

    def set_mode(self, mode: int) -> None:
        """The mode of operation, read back."""
        if not self.backend.has("mode"):
            return
        self.backend.write("mode", mode)
        if not self.backend.has("mode_display"):
            return
        deadline = self.clock() + 1.0
        while self.backend.read("mode_display") != mode:
            if self.clock() > deadline:
                raise DeviceError("does not take the mode", where=self.link.where, value=mode)
            self.sleep(_POLL)

    def disable(self) -> None:
        """Power stage off."""
        self.backend.write("controlword", cia402.DISABLE_VOLTAGE)

    def stop(self) -> None:
        """Halt: decelerate and stay enabled."""
        self.backend.write("controlword", cia402.ENABLE | cia402.HALT)

    def quick_stop(self) -> None:
        """The quick stop of the profile, in one request."""
        self.link.transact(self.backend.quick_stop(self.profile.quickstop.value))

    def home(self, timeout: float = 60.0, should_stop: Callable[[], bool] = lambda: False) -> None:
        """Find the reference; DeviceError where the drive says that it failed, or where it was stopped."""
        self.enable(cia402.HOMING)
        self.backend.write("homing_method", self.config.homing_method or self.profile.homing.method)
        self.backend.write("controlword", cia402.ENABLE)
        self.backend.write("controlword", cia402.ENABLE | cia402.NEW_SET_POINT)
        deadline = self.clock() + timeout
        while True:
            self.sleep(4 * _POLL)
            snapshot = self.backend.snapshot()
            word, status = snapshot["statusword"], self.read_status(snapshot)
            if should_stop():
                self.stop()
                raise DeviceError("homing was stopped", where=self.link.where, remedy="Home again")
            if status.state is State.FAULT or word & cia402.FOLLOWING_ERROR or self.clock() > deadline:
                self.stop()
                raise self._fault(status, "homing failed")
            if word & cia402.SET_POINT_ACKNOWLEDGE and word & cia402.TARGET_REACHED:
                break
        self.backend.write("controlword", cia402.ENABLE)
        self.homed = True

    def jog(self, distance: float, speed: float = 0.02) -> float:
        """Move by `distance` m; returns the travel reached."""
        return self.move_to(self.status().travel + distance, speed)

    def move_to(
        self,
        travel: float,
        speed: float = 0.05,
        acceleration: float = 0.5,
        should_stop: Callable[[], bool] = lambda: False,
    ) -> float:
        """Profile position to `travel` m, waiting until it is reached; InputError outside the stand's limits."""
        low, high = self.limits.travel
        if not low <= travel <= high:
            remedy = f"Stay within {low * 1e3:g} to {high * 1e3:g} mm"
            raise InputError("outside the drive's travel", where="travel", value=travel, remedy=remedy)
        if not 0 < speed <= self.limits.speed:
            remedy = f"At most {self.limits.speed} m/s"
            raise InputError("outside the speed limit", where="speed", value=speed, remedy=remedy)
        self.enable(cia402.PROFILE_POSITION)
        start = self.status().travel
        self._send_set_point(travel, speed, acceleration)
        expected = abs(travel - start) / speed + 2 * speed / acceleration
        return self._await_target(travel, 2.0 + 1.5 * expected, should_stop)

    def _send_set_point(self, travel: float, speed: float, acceleration: float) -> None:
        values = {
            "target_position": self.counts("position", self.config.direction * travel),
            "profile_velocity": self.counts("velocity", speed),
            "profile_acceleration": self.counts("acceleration", acceleration),
            "profile_deceleration": self.counts("acceleration", acceleration),
        }
        known = {name: value for name, value in values.items() if self.backend.has(name)}
        low, high = cia402.set_point()
        self.backend.command({**known, "controlword": low})
        self.backend.command({**known, "controlword": high})

    def _await_target(self, travel: float, timeout: float, should_stop: Callable[[], bool]) -> float:
        deadline = self.clock() + timeout
        self.sleep(2 * _POLL)
        self.backend.write("controlword", cia402.ENABLE | cia402.CHANGE_IMMEDIATELY)
        while True:
            status = self.status()
            if status.state is not State.ENABLED:
                raise self._fault(status)
            near = abs(status.travel - travel) < 2e-4
            if status.target_reached and near:
                return status.travel
            if should_stop():
                self.stop()
                return status.travel
            if self.clock() > deadline:
                self.stop()
                remedy = "Check limits, end switches and load"
                raise DeviceError(
                    "does not reach the target", where=self.link.where, value=status.travel, remedy=remedy
                )
            self.sleep(_POLL)

    def _await(self, done: Callable[[DriveStatus], bool], what: str, timeout: float) -> None:
        deadline = self.clock() + timeout
        while not done(status := self.status()):
            if self.clock() > deadline:
                raise self._fault(status, what)
            self.sleep(_POLL)

    def _fault(self, status: DriveStatus, what: str = "the drive left operation") -> DeviceError:
        value = f"{status.state}, error {status.fault_code:#06x}"
        return DeviceError(what, where=self.link.where, value=value, remedy="Find the cause, then reset the fault")


def quick_stop_telegrams(stand: Stand) -> tuple[bytes, ...]:
    """Complete telegrams, to be sent on a connection of one's own, that stop the drive whatever it does."""
    drive = Drive(stand.drive, stand.limits)
    request = drive.backend.quick_stop(drive.profile.quickstop.value)
    return (drive.link.telegram(request),)
