"""Preparation steps as plain calls: each runs in an acquisition process of its own and blocks until it is done."""

from __future__ import annotations

from collections.abc import Mapping

from stand.config import Stand
from stand.errors import DeviceError, InputError, SafetyTrip, StandError
from stand.runs.checks import RestCheck
from stand.runs.handle import start
from stand.runs.messages import Failed
from stand.runs.order import Step, StepOrder

_KINDS: Mapping[str, type[StandError]] = {
    kind.__name__: kind for kind in (StandError, InputError, DeviceError, SafetyTrip)
}


def take_step(stand: Stand, order: StepOrder) -> Mapping[str, object]:
    """The step's result by name, in SI; the StandError that the step failed with."""
    last = start(stand, order).wait()
    if isinstance(last, Failed):
        raise raised(last)
    return last.result


def raised(failed: Failed) -> StandError:
    """A failure as the error that it was in the acquisition process."""
    kind = _KINDS.get(failed.kind, StandError)
    return kind(failed.what, where=failed.where, value=failed.value, remedy=failed.remedy)


def status(stand: Stand) -> Mapping[str, object]:
    """What every device says of itself; nothing moves."""
    return take_step(stand, StepOrder(Step.STATUS))


def home(stand: Stand) -> float:
    """Find the drive's reference; the travel afterwards, m."""
    return _number(take_step(stand, StepOrder(Step.HOME)), "travel")


def jog(stand: Stand, distance: float, speed: float = 0.02) -> float:
    """Move the drive by `distance` m at `speed` m/s; the travel reached, m."""
    return _number(take_step(stand, StepOrder(Step.JOG, distance, speed)), "travel")


def tare(stand: Stand) -> float:
    """Zero the unloaded force gauge; what it shows then, N."""
    return _number(take_step(stand, StepOrder(Step.TARE)), "force")


def rest_check(stand: Stand) -> RestCheck:
    """The force at rest beside what the setup gives."""
    found = take_step(stand, StepOrder(Step.REST_CHECK))
    return RestCheck(_number(found, "force"), _number(found, "expected"), _number(found, "tolerance"))


def reset(stand: Stand) -> None:
    """Acknowledge the drive's fault, once its cause has been found."""
    take_step(stand, StepOrder(Step.RESET))


def _number(found: Mapping[str, object], name: str) -> float:
    return float(str(found[name]))
