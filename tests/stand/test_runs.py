"""The seam between the acquisition's process and whoever started it."""

from __future__ import annotations

import os
import signal
from datetime import UTC, datetime
from multiprocessing import Pipe
from types import SimpleNamespace

import numpy as np
import pytest

from stand.block import Block
from stand.clock.model import LiveBlock
from stand.config import load_stand
from stand.errors import DeviceError, InputError
from stand.excitation.spec import Excitation, Shape
from stand.runs import Failed, Phase, Progress, RunOrder, Step, StepOrder, jog, raised, start, status
from stand.runs.halt import Halt
from stand.runs.health import Meter
from stand.runs.link import LIVE_WAITING, Tap
from stand.runs.run import Moment, Span
from stand.safety import Trip


def live(first: int) -> LiveBlock:
    part = np.zeros(2000)
    return LiveBlock(first, part, part, part, part, np.zeros(2000, np.uint8), 0.0)


def test_a_slow_reader_loses_live_blocks_and_nothing_else_and_is_told_how_many() -> None:
    ours, theirs = Pipe()
    tap = Tap(theirs)
    sent = 3 * LIVE_WAITING  # far more than the pipe and the tap hold together
    for n in range(sent):
        tap.send(live(n))
    for n in range(50):
        tap.send(Phase("motion", float(n)))
    tap.send(Progress(1.0, 2.0, 0, 0))
    received = []
    while not received or not isinstance(received[-1], Progress):
        received.append(ours.recv())
    tap.close()
    blocks = [message for message in received if isinstance(message, LiveBlock)]
    assert sum(isinstance(message, Phase) for message in received) == 50
    assert tap.dropped > 0
    assert received[-1].dropped == tap.dropped == sent - len(blocks)
    assert [block.first for block in blocks] == sorted(block.first for block in blocks)


def test_an_acquisition_that_dies_is_reported_as_such() -> None:
    handle = start(load_stand(), StepOrder(Step.STATUS))
    os.kill(handle.pid, signal.SIGKILL)
    last = handle.wait()
    assert isinstance(last, Failed)
    assert "died" in last.what
    assert list(handle.events()) == []


def test_a_stand_that_is_not_there_is_named() -> None:
    found = status(load_stand())
    assert "127.0.0.1:502" in found["drive"]["problem"]  # type: ignore[index]
    assert "/dev/ttyUSB0" in found["force_gauge"]["problem"]  # type: ignore[index]
    with pytest.raises(DeviceError, match=r"127\.0\.0\.1:502"):
        jog(load_stand(), 0.001)


def test_errors_keep_their_kind_and_their_words_across_processes() -> None:
    error = raised(Failed("InputError", "no", "there", 3, "Mend it"))
    assert isinstance(error, InputError)
    assert str(error) == "there: no (got 3). Mend it"


def test_a_run_is_named_by_its_time_shape_and_frequency() -> None:
    order = RunOrder(Excitation(Shape.QUASI_SINUSOIDAL, 0.35, 0.09, cycles=3))
    now = datetime(2026, 3, 5, 14, 30, 1, 250000, tzinfo=UTC)
    assert order.file_name(now) == "20260305T143001.25Z_quasi-sinusoidal_0.35Hz.h5"
    assert RunOrder(name="mine").file_name() == "mine.h5"


def test_a_meter_knows_rate_age_and_recent_values() -> None:
    meter = Meter(stale=0.1)
    meter.read(0.0)
    for n in range(10):
        now = 0.1 * (n + 1)
        meter.count(Block("dial_gauge", 200 * n, np.full(200, float(n)), None, np.zeros(200, np.uint8), now))
    health = meter.read(1.05)
    assert health.state == "ok"
    assert health.samples == 2000
    assert health.rate == pytest.approx(2000 / 1.05)
    assert meter.read(1.3).state == "stale"
    assert set(meter.recent()) == {5.0, 6.0, 7.0, 8.0, 9.0}


def test_a_run_whose_guardian_falls_silent_is_tripped_and_never_called_finished() -> None:
    halt, trips = Halt(), []

    def raise_trip(trip: Trip) -> None:
        trips.append(trip)
        halt.want(str(trip))

    rig = SimpleNamespace(
        guardian_trip=lambda: Trip("guardian", "no heartbeat for 0.300 s"),
        supervisor=SimpleNamespace(raise_trip=raise_trip),
        halt=halt,
        publish=lambda event: None,
    )
    moment = Moment(rig, SimpleNamespace(duration=1.0), Span())  # type: ignore[arg-type]  # of both only what a step asks
    assert moment.should_stop()
    assert trips[0].rule == "guardian"
