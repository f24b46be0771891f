"""CiA 402 power state machine, sans-IO: statusword in, next controlword out (CiA 402-2, movingcap web manual)."""

from __future__ import annotations

from enum import StrEnum


class State(StrEnum):
    """The states of the power drive system."""

    NOT_READY = "not ready to switch on"
    DISABLED = "switch-on disabled"
    READY = "ready to switch on"
    SWITCHED_ON = "switched on"
    ENABLED = "operation enabled"
    QUICK_STOP = "quick stop active"
    FAULT_REACTION = "fault reaction active"
    FAULT = "fault"


SHUTDOWN, SWITCH_ON, ENABLE, DISABLE_VOLTAGE, QUICK_STOP, FAULT_RESET, HALT = 0x06, 0x07, 0x0F, 0x00, 0x02, 0x80, 0x100
NEW_SET_POINT, CHANGE_IMMEDIATELY, RELATIVE = 0x10, 0x20, 0x40
TARGET_REACHED, INTERNAL_LIMIT, SET_POINT_ACKNOWLEDGE, FOLLOWING_ERROR = 1 << 10, 1 << 11, 1 << 12, 1 << 13
PROFILE_POSITION, PROFILE_VELOCITY, HOMING = 1, 3, 6

_STATES = (
    (0x4F, 0x00, State.NOT_READY),
    (0x4F, 0x40, State.DISABLED),
    (0x6F, 0x21, State.READY),
    (0x6F, 0x23, State.SWITCHED_ON),
    (0x6F, 0x27, State.ENABLED),
    (0x6F, 0x07, State.QUICK_STOP),
    (0x4F, 0x0F, State.FAULT_REACTION),
    (0x4F, 0x08, State.FAULT),
)
_TOWARDS_ENABLED = {
    State.DISABLED: SHUTDOWN,
    State.READY: SWITCH_ON,
    State.SWITCHED_ON: ENABLE,
    State.QUICK_STOP: DISABLE_VOLTAGE,
}


def state_of(statusword: int) -> State | None:
    """The state that a statusword shows; None for a pattern that CiA 402 doesn't know."""
    return next((state for mask, pattern, state in _STATES if statusword & mask == pattern), None)


def towards_enabled(state: State | None) -> int | None:
    """The controlword that leads one step towards operation enabled; None where only waiting, or a reset, helps."""
    return _TOWARDS_ENABLED.get(state) if state is not None else None


def fault_reset() -> tuple[int, int]:
    """Two controlwords: bit 7 must rise."""
    return (DISABLE_VOLTAGE, FAULT_RESET)


def set_point(immediately: bool = True, relative: bool = False) -> tuple[int, int]:
    """Two controlwords for profile position: bit 4 must rise while the target stands."""
    base = ENABLE | (CHANGE_IMMEDIATELY if immediately else 0) | (RELATIVE if relative else 0)
    return (base, base | NEW_SET_POINT)
