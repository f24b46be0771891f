"""Runs: the acquisition is a process of its own, started and watched through a `RunHandle`."""

from stand.clock.model import LiveBlock
from stand.runs.checks import RestCheck
from stand.runs.handle import Event, RunHandle, emergency_stop, start
from stand.runs.messages import (
    PHASES,
    Failed,
    Finished,
    Health,
    InstrumentHealth,
    Outcome,
    Phase,
    Progress,
)
from stand.runs.order import RunOrder, Step, StepOrder
from stand.runs.prepare import home, jog, raised, reset, rest_check, status, take_step, tare
from stand.safety import Trip

__all__ = [
    "PHASES",
    "Event",
    "Failed",
    "Finished",
    "Health",
    "InstrumentHealth",
    "LiveBlock",
    "Outcome",
    "Phase",
    "Progress",
    "RestCheck",
    "RunHandle",
    "RunOrder",
    "Step",
    "StepOrder",
    "Trip",
    "emergency_stop",
    "home",
    "jog",
    "raised",
    "reset",
    "rest_check",
    "start",
    "status",
    "take_step",
    "tare",
]
