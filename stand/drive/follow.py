"""A planned motion executed: velocity streamed at the command rate, position fed back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from stand.drive import cia402
from stand.drive.cia402 import State
from stand.drive.drive import Drive
from stand.errors import DeviceError

STRAY = 0.025
QUIET = 20e-6
SAFETY_MARGIN = 0.003
LEAST_ACCELERATION = 0.02


class PlannedMotion(Protocol):
    """What `follow` needs of a plan: seconds, displacement from rest m and velocity m/s at a time, its range."""

    @property
    def duration(self) -> float: ...
    @property
    def span(self) -> tuple[float, float]: ...
    def state(self, t: float) -> tuple[float, float]: ...


@dataclass(frozen=True, slots=True)
class Followed:
    """How a motion ended: complete, worst deviation of the drive's demand from the plan m, late steps."""

    complete: bool
    worst: float
    late: int
    started: float


def follow(
    drive: Drive,
    plan: PlannedMotion,
    should_stop: Callable[[], bool] = lambda: False,
    on_start: Callable[[float], None] = lambda started: None,
) -> Followed:
    """Run the plan from where the drive stands; DeviceError where it faults or strays by more than 25 mm.

    Profile velocity with its acceleration set at every step to |dv| / dt: the drive's velocity is then the plan's,
    joined by straight lines between steps, whatever the pace at which the link answers and the time that a command
    needs to reach the drive. Its own software limits are drawn in around the plan, so that a stream that breaks off
    ends there at the latest.
    """
    origin = drive.status().travel
    low, high = plan.span
    bounds = drive.limits.travel
    drive.set_window(max(bounds[0], origin + low - SAFETY_MARGIN), min(bounds[1], origin + high + SAFETY_MARGIN))
    drive.backend.write("target_velocity", 0)
    drive.enable(cia402.PROFILE_VELOCITY)
    try:
        return _stream(drive, plan, origin, should_stop, on_start)
    finally:
        _halt(drive)
        drive.set_window(*bounds)


@dataclass(frozen=True, slots=True)
class _Ramp:
    """The velocity that the drive demands of itself: from `start` at time `at` towards `target`, m/s, s, m/s^2."""

    at: float = 0.0
    start: float = 0.0
    target: float = 0.0
    acceleration: float = LEAST_ACCELERATION

    def velocity(self, t: float) -> float:
        reach = self.acceleration * max(0.0, t - self.at)
        return self.start + min(reach, max(-reach, self.target - self.start))


def _stream(
    drive: Drive,
    plan: PlannedMotion,
    origin: float,
    should_stop: Callable[[], bool],
    on_start: Callable[[float], None],
) -> Followed:
    dt = 1.0 / drive.config.command_rate
    gain, started = drive.profile.motion.gain, drive.clock()
    on_start(started)
    ramp, error, worst, late, step = _Ramp(), 0.0, 0.0, 0, 0
    before, pace, lead = -dt, dt, 0.0
    while (now := drive.clock() - started) < plan.duration:
        if should_stop():
            return Followed(False, worst, late, started)
        late += now > (step + 1) * dt
        pace = max(dt, pace + 0.3 * (min(now - before, 0.05) - pace))
        before = now
        wanted = plan.state(now + lead + pace)[1]
        quiet = wanted == 0.0 and plan.state(now)[1] == 0.0 and abs(error) < QUIET
        command = 0.0 if quiet else wanted + gain * error
        acceleration = max(LEAST_ACCELERATION, abs(command - ramp.velocity(now + lead)) / pace)
        demand = _exchange(drive, command, acceleration)
        looked = drive.link.looked - started
        ramp = _Ramp(looked, ramp.velocity(looked), command, acceleration)
        lead += 0.1 * (min(looked - now, 0.05) - lead)
        error = plan.state(looked)[0] - (demand - origin)
        worst = max(worst, abs(error))
        if worst > STRAY:
            value = f"{error * 1e3:.1f} mm off"
            raise DeviceError("the drive does not follow the plan", where=drive.link.where, value=value)
        step = max(step + 1, int((drive.clock() - started) / dt))
        drive.sleep(max(0.0, started + step * dt - drive.clock()))
    return Followed(True, worst, late, started)


def _exchange(drive: Drive, velocity: float, acceleration: float) -> float:
    """One step on the wire; the position that the drive demands of itself, m of travel."""
    ramp = max(1, drive.counts("acceleration", acceleration))
    counts = drive.counts("velocity", drive.config.direction * velocity)
    values = {"target_velocity": counts, "profile_acceleration": ramp, "profile_deceleration": ramp}
    snapshot = drive.backend.command({**values, "controlword": cia402.ENABLE})
    status = drive.read_status(snapshot)
    if status.state is not State.ENABLED:
        remedy = "Find the cause, then reset the fault"
        value = f"{status.state}, error {status.fault_code:#06x}"
        raise DeviceError("the drive left operation", where=drive.link.where, value=value, remedy=remedy)
    return drive.travel_of(snapshot["position"] + snapshot.get("following_error", 0))


def _halt(drive: Drive) -> None:
    """Velocity to zero at the stand's acceleration; a drive that is not enabled has stopped by itself."""
    ramp = drive.counts("acceleration", drive.limits.acceleration)
    values = {"target_velocity": 0, "profile_acceleration": ramp, "profile_deceleration": ramp}
    if drive.status().state is State.ENABLED:
        drive.backend.command({**values, "controlword": cia402.ENABLE})
