"""One thread that keeps the stand in real time: it sleeps until the next byte is due, never longer than 2 ms."""

from __future__ import annotations

import ctypes
import threading
import time
from collections.abc import Callable, Sequence

from mocks.devices.gauge import Gauge
from mocks.devices.world import World

LONGEST = 2e-3
BEHIND = 0.25
FLUSH = 0.25
_TIMER_SLACK = 29


def sharpen_sleep() -> None:
    """Let this thread wake within microseconds of its time instead of the usual 50 (Linux only; else nothing)."""
    try:
        ctypes.CDLL(None).prctl(_TIMER_SLACK, ctypes.c_ulong(1000), 0, 0, 0)
    except (AttributeError, OSError):
        return


class Scheduler(threading.Thread):
    """Advances the world and serves the gauges; whoever else touches them holds `lock`. flush: called now and then."""

    def __init__(self, world: World, gauges: Sequence[Gauge], flush: Callable[[float], None]) -> None:
        super().__init__(name="scheduler", daemon=True)
        self.world, self.gauges, self.flush = world, gauges, flush
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
        flushed = 0.0
        while not self._ending.is_set():
            with self.lock:
                now = time.monotonic()
                self.tick(now)
                if now - flushed > FLUSH:
                    self.flush(now)
                    flushed = now
                wake = min([now + LONGEST, *(g.wake for g in self.gauges)])
            pause = wake - time.monotonic()
            if pause > 0:
                time.sleep(pause)

    def tick(self, now: float) -> None:
        """Everything up to now; after a long stall in pieces, so that no sample is lost."""
        while now - self.world.now > 2.0 * BEHIND:
            self.look(self.world.now + BEHIND)
        self.world.advance(now)
        for gauge in self.gauges:
            if now >= gauge.wake:
                gauge.step(now)

    def look(self, now: float) -> None:
        """All gauges at a time that may be past."""
        self.world.advance(now)
        for gauge in self.gauges:
            gauge.step(now)

    def end(self) -> None:
        """Stop and wait."""
        self._ending.set()
        if self.is_alive():
            self.join()
