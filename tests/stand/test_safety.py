"""Rules: which block trips, which doesn't; the latch; the quick stop on the wire."""

from __future__ import annotations

import socket
import threading
import time

import numpy as np
import pytest

from stand.block import Block
from stand.guardian.client import StopOrder
from stand.safety import FlagRule, QuickStop, RangeRule, SpeedRule, StaleRule, Supervisor, Trip

TELEGRAM = bytes.fromhex("000100000006010617700002")


def block(values: list[float], first: int = 0, flags: list[int] | None = None, name: str = "force_gauge") -> Block:
    marks = np.array(flags if flags is not None else [0] * len(values), np.uint8)
    return Block(name, first, np.array(values), None, marks, arrival=1.0)


def test_a_force_within_its_range_passes_and_one_sample_above_trips() -> None:
    rule = RangeRule("force", "force_gauge", -20.0, 1000.0, "N")
    assert rule.look(block([0.0, 999.9])) is None
    trip = rule.look(block([0.0, 1000.5, 3.0]))
    assert trip is not None
    assert str(trip) == "force: force_gauge is above its limit (1000.5 N against 1000 N)"


def test_a_value_that_is_not_a_number_trips() -> None:
    trip = RangeRule("force", "force_gauge", -20.0, 1000.0, "N").look(block([1.0, float("nan")]))
    assert trip is not None
    assert "not a number" in trip.what


def test_the_guides_range_counts_from_the_rest() -> None:
    rule = RangeRule("guide range", "dial_gauge", -0.05, 0.25, "m", zero=0.1)
    assert rule.look(block([0.06, 0.34])) is None
    assert rule.look(block([0.04])) is not None


def test_a_speed_above_the_limit_trips_across_blocks() -> None:
    rule = SpeedRule("speed", "drive", 1.0, 1000.0, span=4)
    slow = [0.0009 * k for k in range(10)]
    assert rule.look(block(slow, name="drive")) is None
    trip = rule.look(block([slow[-1] + 0.0011 * k for k in range(1, 6)], first=10, name="drive"))
    assert trip is not None
    assert trip.value == pytest.approx(1.1)


def test_encoder_noise_at_rest_is_no_speed() -> None:
    noise = np.random.default_rng(1).normal(0.03, 1e-6, 5000)
    rule = SpeedRule("speed", "drive", 1.0, 1000.0)
    assert all(
        rule.look(block(list(part), first=i, name="drive")) is None for i, part in enumerate(np.split(noise, 500))
    )


def test_a_lost_piece_of_the_ring_is_no_jump_in_speed() -> None:
    rule = SpeedRule("speed", "drive", 1.0, 1000.0, span=4)
    flags = np.zeros(10, np.uint8)
    for start in (0, 40):
        ticks = np.arange(start, start + 10)
        assert rule.look(Block("drive", start, 0.0009 * ticks, ticks, flags, 1.0)) is None


def test_a_sample_that_the_device_itself_doubts_trips_by_its_flag_alone() -> None:
    overloaded = block([1.0, 5000.0], flags=[0, 1])
    assert RangeRule("force", "force_gauge", -20.0, 1000.0, "N").look(overloaded) is None
    assert FlagRule("device flag", "force_gauge").look(overloaded) is not None


def test_silence_trips_for_the_instrument_that_is_silent() -> None:
    rule = StaleRule({"drive": 0.1, "force_gauge": 0.1})
    rule.start(10.0)
    rule.heard("drive", 10.15)
    trip = rule.look(10.2)
    assert trip is not None
    assert trip.instrument == "force_gauge"


def test_the_first_trip_stops_once_and_stays() -> None:
    seen: list[Trip] = []
    supervisor = Supervisor([RangeRule("force", "force_gauge", 0.0, 10.0, "N")], seen.append)
    supervisor.look(block([11.0]))
    supervisor.look(block([99.0]))
    supervisor.look(block([5.0]))
    assert [trip.value for trip in seen] == [11.0]
    assert supervisor.trip is seen[0]


def test_the_watchdog_notices_silence_by_itself() -> None:
    tripped = threading.Event()
    supervisor = Supervisor([], lambda _trip: tripped.set(), stale=StaleRule({"drive": 0.03}))
    supervisor.start()
    assert tripped.wait(2.0)
    supervisor.close()


class OneDrive:
    """Answers every telegram with itself, as function 6 does, and remembers when it came."""

    def __init__(self) -> None:
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port = self._server.getsockname()[1]
        self.received: list[tuple[float, bytes]] = []
        self.came = threading.Event()
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        while True:
            connection, _ = self._server.accept()
            threading.Thread(target=self._serve, args=(connection,), daemon=True).start()

    def _serve(self, connection: socket.socket) -> None:
        while data := connection.recv(512):
            self.received.append((time.monotonic(), data))
            self.came.set()
            connection.sendall(data)


def test_the_quick_stop_is_on_the_wire_at_once_and_is_repeated() -> None:
    drive = OneDrive()
    stop = QuickStop(StopOrder("tcp", "127.0.0.1", drive.port, (TELEGRAM,)))
    stop.start()
    asked = time.monotonic()
    stop.trigger()
    assert stop.confirmed.wait(2.0)
    while len(drive.received) < 3:
        time.sleep(0.002)
    stop.close()
    assert drive.received[0][1] == TELEGRAM
    assert drive.received[0][0] - asked < 0.02


def test_from_the_sample_to_the_stop_on_the_wire_it_takes_a_few_milliseconds() -> None:
    delays = []
    for _ in range(30):
        drive = OneDrive()
        stop = QuickStop(StopOrder("tcp", "127.0.0.1", drive.port, (TELEGRAM,)))
        stop.start()
        supervisor = Supervisor([RangeRule("force", "force_gauge", 0.0, 10.0, "N")], lambda _t, s=stop: s.trigger())
        shown = time.monotonic()
        supervisor.look(block([11.0]))
        assert drive.came.wait(2.0)
        delays.append(drive.received[0][0] - shown)
        stop.close()
    assert float(np.median(delays)) < 0.01
