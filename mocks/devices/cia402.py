"""CiA 402's states of a power drive: what a controlword does, what the statusword says."""

from __future__ import annotations

from enum import Enum


class State(Enum):
    """A state and its bits in the statusword."""

    DISABLED = 0x0040
    READY = 0x0021
    SWITCHED_ON = 0x0023
    ENABLED = 0x0027
    QUICK_STOP = 0x0007
    FAULT_REACTION = 0x000F
    FAULT = 0x0008


class Command(Enum):
    """The commands of a controlword."""

    SHUTDOWN = "shutdown"
    SWITCH_ON = "switch on"
    ENABLE = "enable operation"
    DISABLE_VOLTAGE = "disable voltage"
    QUICK_STOP = "quick stop"


def command(word: int) -> Command:
    """The command that bits 0 to 3 of a controlword stand for."""
    if not word & 0x02:
        return Command.DISABLE_VOLTAGE
    if not word & 0x04:
        return Command.QUICK_STOP
    if not word & 0x01:
        return Command.SHUTDOWN
    return Command.ENABLE if word & 0x08 else Command.SWITCH_ON


_NEXT: dict[tuple[State, Command], State] = {
    (State.DISABLED, Command.SHUTDOWN): State.READY,
    (State.READY, Command.SWITCH_ON): State.SWITCHED_ON,
    (State.READY, Command.ENABLE): State.ENABLED,
    (State.READY, Command.DISABLE_VOLTAGE): State.DISABLED,
    (State.READY, Command.QUICK_STOP): State.DISABLED,
    (State.SWITCHED_ON, Command.ENABLE): State.ENABLED,
    (State.SWITCHED_ON, Command.SHUTDOWN): State.READY,
    (State.SWITCHED_ON, Command.DISABLE_VOLTAGE): State.DISABLED,
    (State.SWITCHED_ON, Command.QUICK_STOP): State.DISABLED,
    (State.ENABLED, Command.SWITCH_ON): State.SWITCHED_ON,
    (State.ENABLED, Command.SHUTDOWN): State.READY,
    (State.ENABLED, Command.DISABLE_VOLTAGE): State.DISABLED,
    (State.ENABLED, Command.QUICK_STOP): State.QUICK_STOP,
    (State.QUICK_STOP, Command.DISABLE_VOLTAGE): State.DISABLED,
    (State.QUICK_STOP, Command.ENABLE): State.ENABLED,
}


def after(state: State, word: int) -> State:
    """The state that a controlword leads to; the same where the command means nothing in it."""
    return _NEXT.get((state, command(word)), state)


def statusword(state: State, word: int = 0, *, bits: int = 0) -> int:
    """State bits, voltage enabled, quick stop (low active), remote, and what else is set in `bits`."""
    found = state.value | 0x0210 | bits
    if state in (State.DISABLED, State.FAULT) and word & 0x04:
        found |= 0x0020
    return found
