"""The same acquisition on replayed devices: nothing is commanded, everything else is as in a run."""

from __future__ import annotations

import time
from pathlib import Path

import h5py

from stand.config import Stand, load_stand_text
from stand.errors import DeviceError, InputError
from stand.recorder import FilePlan, Recorder
from stand.recorder.finish import finish_file
from stand.recorder.inject import injected
from stand.runs.messages import Finished, Outcome, Phase, Progress
from stand.runs.order import RunOrder
from stand.runs.rig import Rig
from stand.runs.run import Span
from stand.runs.streams import stream_specs

SILENCE = 0.5
BEGINNING = 10.0


def perform_replay(rig: Rig, order: RunOrder, path: Path) -> Finished:
    """Record what the replayed devices send, for `order.seconds` or until they fall silent."""
    if order.speed != 1.0 and order.inject is None:
        what = "a replay at another speed has no time of its own"
        raise InputError(what, where="replay", value=order.speed, remedy="Inject the recorded arrivals, or use 1")
    span = Span()
    rig.publish(Phase("connect", time.monotonic()))
    rig.connect()
    identities = {name: dict(reader.identify()) for name, reader in rig.readers.items() if name == "drive"}
    recorder = Recorder(path, _plan(rig, order, identities))
    recorder.start()
    rig.acquisition.record(recorder)
    try:
        _listen(rig, order, span)
    finally:
        rig.end_reading()
        rig.publish(Phase("align", time.monotonic()))
        recorder.close()
    return _close(rig, order, path, span)


def _plan(rig: Rig, order: RunOrder, identities: dict[str, dict[str, str]]) -> FilePlan:
    stand, about = rig.stand, {"title": order.name, "comment": order.comment or "replay"}
    seconds = order.seconds or 60.0
    specs = stream_specs(stand, identities)
    return FilePlan(specs, stand.setup, order.excitation, stand.to_toml(), seconds, about)


def _listen(rig: Rig, order: RunOrder, span: Span) -> None:
    rig.read_unwatched()
    _await_gauges(rig)
    span.origin = span.end = time.monotonic()
    rig.acquisition.align_from(span.origin)
    rig.publish(Phase("motion", span.origin, "replay"))
    while not rig.halt.wait(0.02) and not _over(rig, order, span):
        span.end = time.monotonic()
    rig.publish(Progress(span.end - span.origin, order.seconds, 0, 0))


def _await_gauges(rig: Rig) -> None:
    """A replay begins once all listen: the grid must not, before there is something on it."""
    gauges = [meter for name, meter in rig.acquisition.meters.items() if name != "drive"]
    end = time.monotonic() + BEGINNING
    while not all(meter.samples for meter in gauges) and not rig.halt.wait(0.002):
        if time.monotonic() > end:
            raise DeviceError("sends nothing", where="replay", remedy="Is the recording being played?")


def _over(rig: Rig, order: RunOrder, span: Span) -> bool:
    now = time.monotonic()
    whole = order.inject is not None  # the raw streams begin before the grid and end after it
    if not whole and order.seconds and now - span.origin >= order.seconds:
        return True
    return all(meter.lost or meter.age(now) > SILENCE for meter in rig.acquisition.meters.values())


def _close(rig: Rig, order: RunOrder, path: Path, span: Span) -> Finished:
    outcome = Outcome.STOPPED if rig.halt.wanted() else Outcome.FINISHED
    why, streams, stand, origin, count = rig.halt.reason, None, rig.stand, span.origin, span.count
    if order.inject is not None:
        streams = injected(path, order.inject)
        stand, origin, count = _recorded(order.inject)
    finish_file(path, stand, origin=origin, count=count, outcome=outcome, why=why, streams=streams)
    rig.publish(Phase("done", time.monotonic()))
    return Finished(path, outcome, why)


def _recorded(path: Path) -> tuple[Stand, float, int]:
    """The calibrated stand of a recording, and its grid's origin s and samples: its arrivals mean nothing without."""
    with h5py.File(path, "r") as source:
        stand = load_stand_text(source["entry/configuration"][()].decode(), f"{path}:/entry/configuration")
        data = source["entry/data"]
        return stand, float(data.attrs["host_origin"]), len(data["time"])
