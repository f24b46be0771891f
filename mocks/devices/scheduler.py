"""One thread that keeps the stand in real time: it sleeps until the next byte is due, never longer than 2 ms."""

from __future__ import annotations

import ctypes
import threading
import time
from collections.abc import Callable, Sequence

from mocks.devices.gauge import Gauge
from mocks.devices.world import World

LONGEST = 2e-3
LEAD = 0.35e-3  # s before bytes are due, at most, in which they are made
BEHIND = 0.25
FLUSH = 0.25
_TIMER_SLACK = 29


def sharpen_sleep() -> None:
    """Let this thread wake within microseconds of its time instead of the usual 50 (Linux only; else nothing)."""
    try:
        ctypes.CDLL(None).prctl(_TIMER_SLACK, ctypes.c_ulong(1000), 0, 0, 0)
    except (AttributeError, OSError):
        return


def sleep_until(time_to_wake: float) -> None:
    """Not at all where it is past."""
    pause = time_to_wake - time.monotonic()
    if pause > 0:
        time.sleep(pause)


class Scheduler(threading.Thread):
    """Advances the world and serves the gauges; whoever else touches them holds `lock`. flush: called now and then."""

    def __init__(self, world: World, gauges: Sequence[Gauge], flush: Callable[[float], None]) -> None:
        super().__init__(name="scheduler", daemon=True)
        self.world, self.gauges, self.flush = world, gauges, flush
        self.lock = threading.Lock()
        self.error: BaseException | None = None
        self.lead = min(LEAD, *(0.9 * gauge.latency for gauge in gauges))
        self._ending = threading.Event()

    def run(self) -> None:
        """Until `end`; what goes wrong is kept in `error`."""
        sharpen_sleep()
        try:
            self._loop()
        except BaseException as error:  # the main thread reports it and ends the process
            self.error = error
            raise

    def _loop(self) -> None:
        flushed = 0.0
        while not self._ending.is_set():
            wake = min(g.wake for g in self.gauges)
            sleep_until(min(wake, time.monotonic() + LONGEST) - self.lead)
            with self.lock:
                self.prepare(time.monotonic())
            sleep_until(wake)
            for gauge in self.gauges:
                gauge.hand_over(time.monotonic())
            if wake - flushed > FLUSH:
                self.flush(wake)
                flushed = wake

    def prepare(self, now: float) -> None:
        """Everything up to now, short of handing it over; after a long stall in pieces, so that no sample is lost."""
        while now - self.world.now > 2.0 * BEHIND:
            self.look(self.world.now + BEHIND)
        self.world.advance(now)
        for gauge in self.gauges:
            if gauge.wake <= now + 1.2 * self.lead:
                gauge.prepare(now)

    def look(self, now: float) -> None:
        """All gauges at a time that is past."""
        self.world.advance(now)
        for gauge in self.gauges:
            gauge.prepare(now)

    def end(self) -> None:
        """Stop and wait."""
        self._ending.set()
        if self.is_alive():
            self.join()
