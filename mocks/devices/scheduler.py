"""One thread that keeps the stand in real time: it sleeps until the next byte is due, not much longer than 6 ms."""

from __future__ import annotations

import ctypes
import threading
import time
from collections.abc import Sequence

from mocks.devices.gauge import WRITING, Gauge
from mocks.devices.world import World

LONGEST = 6e-3
MUCH, EARLY = 3e-3, 0.8e-3  # s of the world that are made beforehand, and so long before
LEAD = 0.5e-3  # s before bytes are due, at most, in which they are made
SOON = 20e-6  # s by which this may begin early
BEHIND = 0.25
WAKING = 35e-6  # s
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


def begin_of(gauge: Gauge) -> float:
    """When to begin with what the gauge hands over next."""
    return gauge.wake - min(LEAD, 0.95 * gauge.foresight)


def await_sharply(moment: float) -> None:
    """As `sleep_until`, the last of it awake: a process that sleeps is woken some 20 us late."""
    sleep_until(moment - WAKING)
    while time.monotonic() < moment:
        pass


class Scheduler(threading.Thread):
    """Advances the world and serves the gauges; whoever else touches them holds `lock`."""

    def __init__(self, world: World, gauges: Sequence[Gauge]) -> None:
        super().__init__(name="scheduler", daemon=True)
        self.world, self.gauges = world, gauges
        self.lock = threading.Lock()
        self.error: BaseException | None = None
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
        while not self._ending.is_set():
            self._step()

    def _step(self) -> None:
        """What is due next is made and handed over; where much is to be made, most of it is made before."""
        due = min(map(begin_of, self.gauges))
        if due - self.world.now > MUCH:
            sleep_until(min(due - EARLY, time.monotonic() + LONGEST))
            with self.lock:
                self.look(time.monotonic())
            return
        sleep_until(due)
        with self.lock:
            made = self.prepare(time.monotonic())
        for gauge in made:
            await_sharply(gauge.wake - WRITING)
            gauge.send(time.monotonic())
        for gauge in made:
            gauge.book(time.monotonic())

    def prepare(self, now: float) -> list[Gauge]:
        """Everything that is due soon, short of handing it over; returns these gauges in their order.

        Only what they have made by now may be handed over.
        """
        self._catch_up(now)
        due = sorted((g for g in self.gauges if begin_of(g) <= now + SOON), key=lambda gauge: gauge.wake)
        for gauge in due:
            gauge.prepare(now)
        return due

    def look(self, now: float) -> None:
        """World and gauges up to now."""
        self._catch_up(now)
        for gauge in self.gauges:
            gauge.prepare(now)

    def _catch_up(self, now: float) -> None:
        """After a long stall in pieces, so that no sample is lost."""
        while now - self.world.now > 2.0 * BEHIND:
            self.world.advance(self.world.now + BEHIND)
            for gauge in self.gauges:
                gauge.prepare(self.world.now)
        self.world.advance(now)

    def end(self) -> None:
        """Stop and wait."""
        self._ending.set()
        if self.is_alive():
            self.join()
