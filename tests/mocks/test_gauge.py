"""The simulated gauges' timing, through simulated time: when samples are taken and when their bytes arrive."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest

from mocks.devices.clock import DeviceClock
from mocks.devices.gauge import Gauge, Sensing
from mocks.devices.heads import DialHead, ForceHead
from mocks.devices.scheduler import Scheduler
from mocks.ledger import DROPPED, OVERRUN
from mocks.wire.line import Adapter, Line

CONVERSION = 150e-6


class Host:
    """Stands in for the terminal: keeps what arrives with the time of its arrival."""

    def __init__(self, room: float = np.inf) -> None:
        self.now, self.room = 0.0, room
        self.data, self.arrivals, self.asks = bytearray(), list[tuple[float, int]](), list[bytes]()

    def connect(self) -> None: ...

    def disconnect(self) -> None: ...

    def watched(self) -> tuple[bool, bool]:
        return True, bool(self.asks)

    def read(self) -> bytes:
        return self.asks.pop(0)

    def write(self, data: bytes) -> int:
        taken = int(min(len(data), self.room))
        self.data += data[:taken]
        self.arrivals.append((self.now, taken))
        return taken


def gauge(head: Any, host: Host, rows: list[Any], drift: float = 0.0, **changed: Any) -> Gauge:
    adapter = Adapter(np.random.default_rng(1), changed.pop("timer", 0.0), changed.pop("jitter", (0.0, 0.0)), 0.003)
    parts: dict[str, Any] = {
        "name": "gauge",
        "head": head,
        "terminal": host,
        "clock": DeviceClock(0.0001, drift),
        "sensing": Sensing(noise=0.0, step=0.0, zero=0.0, conversion=CONVERSION, limit=1e3),
        "line": Line(10.0 / 230_400),
        "adapter": adapter,
        "signal": lambda times: (times * 10.0, times * 10.0),
        "rng": np.random.default_rng(0),
        "log": rows.append,
        "host_time": lambda: host.now,
    }
    return Gauge(**(parts | changed))


def run(device: Gauge, host: Host, seconds: float, late: float = 20e-6) -> None:
    """As the scheduler does: prepared a little before, handed over when it is due."""
    while host.now < seconds:
        due = max(device.wake, host.now + 1e-4)
        device.prepare(max(due - 0.9 * device.latency, 0.0))
        host.now = due + late
        device.hand_over(host.now)


def column(rows: list[Any], name: str) -> np.ndarray:
    return np.concatenate([getattr(r, name) for r in rows])


@pytest.mark.parametrize("drift", [-50e-6, 0.0, 37e-6, 50e-6])
def test_sample_k_is_taken_at_its_device_time_and_worth_what_was_true_then(drift: float) -> None:
    host, rows = Host(), list[Any]()
    run(gauge(ForceHead(), host, rows, drift), host, 1.0)
    k = column(rows, "counter")
    assert np.array_equal(k, np.arange(len(k)))
    times = 0.0001 + k / 2000.0 / (1.0 + drift)
    assert column(rows, "true_time") == pytest.approx(times, abs=1e-12)
    assert column(rows, "true_value") == pytest.approx(times * 10.0)
    assert np.array_equal(column(rows, "value"), (times * 10.0).astype(np.float32))


@pytest.mark.parametrize(("head", "size"), [(ForceHead, 8), (DialHead, 15)])
def test_no_frame_arrives_before_it_can_and_the_last_of_a_batch_at_once(head: Any, size: int) -> None:
    host, rows = Host(), list[Any]()
    run(gauge(head(), host, rows, line=Line(10.0 / 921_600)), host, 1.0)
    after = column(rows, "handed") - column(rows, "true_time")
    latency = CONVERSION + size * 10.0 / 921_600
    assert after.min() == pytest.approx(latency + 20e-6, abs=1e-9)
    assert after.max() < latency + 2e-3
    assert len(host.data) == size * len(column(rows, "counter"))


def test_a_timer_hands_over_what_has_left_the_line_by_its_tick_frames_or_not() -> None:
    host, rows = Host(), list[Any]()
    device = gauge(ForceHead(), host, rows, drift=25e-6, timer=0.016 * 1.003)
    run(device, host, 2.0)
    when = np.array([t for t, n in host.arrivals if n])
    assert np.diff(when) == pytest.approx(0.016 * 1.003, abs=1e-9)
    assert any(n % 8 for _, n in host.arrivals)
    latency = CONVERSION + 8 * 10.0 / 230_400
    after = column(rows, "handed") - column(rows, "true_time")
    assert latency <= after.min() < latency + 0.1e-3
    assert after.max() < latency + 0.0165


def test_the_hosts_jitter_comes_on_top() -> None:
    host, rows = Host(), list[Any]()
    run(gauge(ForceHead(), host, rows, jitter=(1e-4, 3e-4)), host, 2.0)
    after = column(rows, "handed") - column(rows, "true_time")
    latency = CONVERSION + 8 * 10.0 / 230_400
    assert latency + 1e-4 <= after.min() < latency + 1.4e-4


def test_dropped_frames_are_counted_but_never_sent() -> None:
    host, rows = Host(), list[Any]()
    device = gauge(ForceHead(), host, rows)
    device.trouble.drop = 5
    run(device, host, 0.1)
    flags, k = column(rows, "flags"), column(rows, "counter")
    assert np.count_nonzero(flags & DROPPED) == 5
    assert np.all(np.isnan(column(rows, "handed")[flags & DROPPED != 0]))
    assert len(host.data) == 8 * (len(k) - 5)


def test_silence_lasts_its_time_to_the_sample() -> None:
    host, rows = Host(), list[Any]()
    device = gauge(ForceHead(), host, rows)
    device.trouble.silent = 0.0501
    run(device, host, 0.2)
    assert np.count_nonzero(column(rows, "flags") & DROPPED) == 100


def test_what_the_host_does_not_take_is_booked_as_overrun() -> None:
    host, rows = Host(room=20), list[Any]()
    run(gauge(ForceHead(), host, rows), host, 0.1)
    flags = column(rows, "flags")
    assert np.count_nonzero(flags & OVERRUN) > 10
    assert np.all(np.isnan(column(rows, "handed")) == (flags & OVERRUN != 0))


def test_a_new_rate_counts_on_from_where_it_was_set() -> None:
    host, rows = Host(), list[Any]()
    device = gauge(ForceHead(), host, rows)
    run(device, host, 0.1)
    host.asks.append(bytes.fromhex("aa948b447a000085"))
    run(device, host, 0.3)
    assert b"\xaa\x50\x00\x85" in host.data
    assert np.diff(column(rows, "true_time"))[-100:] == pytest.approx(1e-3)
    assert np.all(np.diff(column(rows, "counter")) == 1)


def test_a_rate_that_the_line_cannot_carry_is_refused() -> None:
    device = gauge(ForceHead(), Host(), [])
    with pytest.raises(ValueError, match="more than the line's 23040 bytes a second"):
        device.set_rate(4000.0)


def test_zeroing_takes_the_present_value_away() -> None:
    host, rows = Host(), list[Any]()
    device = gauge(ForceHead(), host, rows, signal=lambda t: (0.0 * t + 12.0, 0.0 * t + 12.0))
    run(device, host, 0.1)
    host.asks.append(bytes.fromhex("aa910c0085"))
    run(device, host, 0.2)
    assert column(rows, "value")[0] == 12.0
    assert column(rows, "value")[-1] == column(rows, "true_value")[-1] == 0.0


def test_a_stopped_stream_stays_stopped_until_it_is_started() -> None:
    host, rows = Host(), list[Any]()
    device = gauge(ForceHead(), host, rows)
    run(device, host, 0.05)
    host.asks.append(bytes.fromhex("aa902385"))
    run(device, host, 0.1)
    sent = len(host.data)
    run(device, host, 0.2)
    assert len(host.data) == sent
    host.asks.append(bytes.fromhex("aa902485"))
    run(device, host, 0.3)
    gaps = np.diff(column(rows, "counter"))
    assert gaps.max() == pytest.approx(300, abs=20)


class Still:
    """Stands in for the plant."""

    now = 0.0

    def advance(self, now: float) -> None:
        self.now = max(self.now, now)


@pytest.mark.parametrize("shift", [0.0, 0.0002, 0.0003, 0.004, 0.009])
def test_two_gauges_on_16_ms_timers_both_keep_streaming(shift: float) -> None:
    devices, hosts, logs = [], [Host(), Host()], [list[Any](), list[Any]()]
    for host, rows, phase in zip(hosts, logs, (0.003, 0.003 + shift), strict=True):
        device = gauge(ForceHead(), host, rows, timer=0.016, jitter=(1e-4, 3e-4), host_time=time.monotonic)
        begun = time.monotonic()
        device.clock, device.adapter.phase = DeviceClock(begun, 0.0), begun + phase
        devices.append(device)
    scheduler = Scheduler(Still(), devices)  # type: ignore[arg-type]
    Still.now = time.monotonic()
    scheduler.start()
    time.sleep(0.3)
    scheduler.end()
    assert scheduler.error is None
    for rows in logs:
        after = column(rows, "handed") - column(rows, "true_time")
        assert len(after) > 400
        assert np.median(after) < 0.0165
