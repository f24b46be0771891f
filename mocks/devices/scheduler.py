"""One thread that keeps the stand in real time: it sleeps until the next byte is due, never longer than 6 ms."""

from __future__ import annotations

import ctypes
import threading
import time
from collections.abc import Callable, Sequence

from mocks.devices.gauge import Gauge
from mocks.devices.world import World

LONGEST = 6e-3
LEAD = 0.35e-3  # s before bytes are due, at most, in which they are made
SOON = 1.05  # leads before bytes are due in which they may be made
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
        self.lead = min(LEAD, *(0.9 * gauge.foresight for gauge in gauges))
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
            self._step()
            if (now := time.monotonic()) - flushed > FLUSH:
                self.flush(now)
                flushed = now

    def _step(self) -> None:
        """What is due next is made and handed over; a look at the world where nothing is due for a while."""
        wake = min(gauge.wake for gauge in self.gauges)
        soon = time.monotonic() + LONGEST
        sleep_until(min(wake - self.lead, soon))
        with self.lock:
            made = self.prepare(time.monotonic(), everything=wake - self.lead > soon)
        for gauge in made:
            sleep_until(gauge.wake)
            gauge.hand_over(time.monotonic())

    def prepare(self, now: float, everything: bool = False) -> list[Gauge]:
        """Everything up to now, short of handing it over; after a long stall in pieces, so that no sample is lost.

        Returns the gauges that are due soon, in their order: only what they have made by now may be handed over.
        """
        while now - self.world.now > 2.0 * BEHIND:
            self.look(self.world.now + BEHIND)
        self.world.advance(now)
        due = sorted((g for g in self.gauges if g.wake <= now + SOON * self.lead), key=lambda gauge: gauge.wake)
        for gauge in self.gauges if everything else due:
            gauge.prepare(now)
        return due

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
