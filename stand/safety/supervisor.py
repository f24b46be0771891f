"""The one place through which every block passes first, and the latch that holds the first trip."""

from __future__ import annotations

import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import replace

from stand.block import Block
from stand.safety.rules import Rule, StaleRule
from stand.safety.trip import Trip


class Supervisor:
    """Looks at every block in its reader's thread; the first trip calls `on_trip` there and then, once.

    on_trip: must not block. stale: the watchdog's rule, asked every `period` s by a thread of its own.
    others: further questions asked by that thread (guardian alive, recorder alive): a sentence is a trip.
    """

    def __init__(
        self,
        rules: Iterable[Rule],
        on_trip: Callable[[Trip], None],
        *,
        stale: StaleRule | None = None,
        others: Iterable[Callable[[], Trip | None]] = (),
        period: float = 0.005,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._rules: dict[str, list[Rule]] = defaultdict(list)
        for rule in rules:
            self._rules[rule.instrument].append(rule)
        self._on_trip, self._stale, self._others = on_trip, stale, list(others)
        self._period, self._clock = period, clock
        self._lock, self._leave = threading.Lock(), threading.Event()
        self._thread: threading.Thread | None = None
        self.trip: Trip | None = None

    def add(self, rule: Rule) -> None:
        """One more rule, from the next block on (limits whose zero is only known after the rest)."""
        self._rules[rule.instrument] = [*self._rules[rule.instrument], rule]

    def look(self, block: Block) -> None:
        """Judge one block; called by its reader before anything else sees it."""
        if self._stale is not None:
            self._stale.heard(block.instrument, block.arrival)
        for rule in self._rules[block.instrument]:
            trip = rule.look(block)
            if trip is not None:
                self.raise_trip(trip)

    def raise_trip(self, trip: Trip) -> None:
        """Latch this trip unless there was one before; the first one stops the drive."""
        with self._lock:
            if self.trip is not None:
                return
            self.trip = replace(trip, seen=self._clock())
        self._on_trip(self.trip)

    def start(self) -> None:
        """Start the watchdog's thread."""
        if self._stale is not None:
            self._stale.start(self._clock())
        self._thread = threading.Thread(target=self._watch, name="watchdog", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the watchdog; rules are still asked as long as blocks come."""
        self._leave.set()
        if self._thread is not None:
            self._thread.join(1.0)

    def _watch(self) -> None:
        while not self._leave.wait(self._period):
            trip = self._stale.look(self._clock()) if self._stale is not None else None
            for ask in self._others:
                trip = trip or ask()
            if trip is not None:
                self.raise_trip(trip)
