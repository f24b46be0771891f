"""Preparation steps that can be asked for alone; each opens the stand, does one thing and lets go."""

from __future__ import annotations

import contextlib
import dataclasses
import time

from stand.errors import DeviceError, SafetyTrip
from stand.runs.checks import RestCheck, check_state, rest_force
from stand.runs.messages import Finished, Outcome, Phase
from stand.runs.order import Step, StepOrder
from stand.runs.rig import Rig
from stand.runs.rules import preparing_rules

LISTEN = 0.5


def perform_step(rig: Rig, order: StepOrder) -> Finished:
    """Do one step on an unconnected rig; StandError where it can't be done."""
    rig.publish(Phase(order.step.value, time.monotonic()))
    if order.step is not Step.STATUS:
        rig.connect()
    result = {
        Step.STATUS: _status,
        Step.HOME: _home,
        Step.JOG: _jog,
        Step.TARE: _tare,
        Step.REST_CHECK: _rest_check,
        Step.RESET: _reset,
    }[order.step](rig, order)
    if rig.trip is not None:
        raise SafetyTrip(str(rig.trip), where=rig.trip.instrument)
    return Finished(None, Outcome.FINISHED, result=result)


def _status(rig: Rig, order: StepOrder) -> dict[str, object]:
    """What each device says of itself, by name; where one can't be reached its state says why. Nothing moves."""
    problems = rig.connect_what_answers()
    found: dict[str, object] = {name: {"state": "lost", "problem": problem} for name, problem in problems.items()}
    with contextlib.suppress(DeviceError):  # a silent one shows as stale
        rig.read_unwatched()
        rig.halt.wait(LISTEN)
    now = time.monotonic()
    for name in rig.readers:
        meter = rig.acquisition.meters[name]
        health, recent = meter.read(now), meter.recent()
        state = {"state": health.state, "samples": health.samples}
        value = float(recent.mean()) if len(recent) else None
        found[name] = {**rig.identities.get(name, {}), **state, "value": value}
    if "drive" not in problems:
        status = dataclasses.asdict(rig.drive.status())
        found["drive_status"] = {name: _plain(value) for name, value in status.items()}
    return found


def _plain(value: object) -> object:
    return value if value is None or isinstance(value, bool | int | float) else str(value)


def _home(rig: Rig, order: StepOrder) -> dict[str, object]:
    """Find the reference, then go to where runs rest."""
    with _Moving(rig):
        rig.drive.home(should_stop=rig.halt.wanted)
        rig.drive.move_to(rig.stand.drive.rest_travel, should_stop=rig.halt.wanted)
    return {"travel": rig.drive.status().travel}


def _jog(rig: Rig, order: StepOrder) -> dict[str, object]:
    with _Moving(rig):
        target = rig.drive.status().travel + order.distance
        rig.drive.move_to(target, order.speed, should_stop=rig.halt.wanted)
    return {"travel": rig.drive.status().travel}


def _tare(rig: Rig, order: StepOrder) -> dict[str, object]:
    """Zero the force gauge: its operator has taken the load off."""
    gauge = rig.readers["force_gauge"]
    gauge.zero()  # type: ignore[attr-defined]
    rig.read([])
    rig.halt.wait(LISTEN)
    return {"force": float(rig.acquisition.meters["force_gauge"].recent().mean())}


def _rest_check(rig: Rig, order: StepOrder) -> dict[str, object]:
    rig.read([])
    rig.halt.wait(LISTEN)
    found = rest_force(rig)
    return {**dataclasses.asdict(found), "ok": found.ok}


def _reset(rig: Rig, order: StepOrder) -> dict[str, object]:
    rig.drive.fault_reset()
    return {"state": str(rig.drive.status().state)}


class _Moving:
    """Streams, rules and guardian around a movement; the drive rests afterwards."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig

    def __enter__(self) -> None:
        check_state(self._rig)
        self._rig.arm()
        self._rig.read(preparing_rules(self._rig.stand))
        self._rig.drive.enable()

    def __exit__(self, *_: object) -> None:
        self._rig.come_to_rest()


__all__ = ["RestCheck", "perform_step"]
