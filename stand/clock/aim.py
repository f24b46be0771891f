"""When to poll the ring: at the edges between its samples, where an answer tells most about its clock.

A poll in the middle of a sample's millisecond only says that nothing is odd; one that falls within some ten
microseconds of an edge says on which side of it the read was. The polls so far say where the edges are.
"""

from __future__ import annotations

import random
from collections import deque

import numpy as np

from stand.clock.ring import fit_ring

KEPT, FIRST, EVERY = 240, 60, 120
#: share of the polls that stay dithered over the whole period, should the aim be wrong
DITHERED = 0.2


class Aim:
    """Chooses poll times. period: of the polls, s; tick: of the ring, s."""

    def __init__(self, period: float, tick: float, dither: float, seed: int | None = None) -> None:
        self.period, self.tick, self.dither = period, tick, dither
        self._random = random.Random(seed)
        self._polls: deque[tuple[int, float, float]] = deque(maxlen=KEPT)
        self._clock: tuple[float, float, float] | None = None
        self._count, self._late = 0, 0.0
        self._due = -np.inf

    def polled(self, head: int, request: float, response: float) -> None:
        """Take a poll's outcome in."""
        self._polls.append((head, request, response))
        self._count += 1
        if np.isfinite(self._due):
            self._late += 0.05 * (min(request - self._due, 5e-4) - self._late)
        if self._count == FIRST or self._count % EVERY == 0:
            heads, asked, answered = (np.array(part) for part in zip(*self._polls, strict=True))
            clock = fit_ring(heads.astype(np.int64), asked, answered, self.tick, 0.0, 0.0)
            self._clock = (clock.offset, clock.period, float(np.quantile(answered - asked, 0.2)))

    def next(self, after: float) -> float:
        """When to ask next, at about `after`, s."""
        if self._clock is None or self._random.random() < DITHERED:
            self._due = -np.inf
            return after + self._random.uniform(-self.dither, self.dither)
        offset, tick, trip = self._clock
        edge = offset + tick * round((after - offset) / tick)
        spread = max(15e-6, 0.2 * trip)
        self._due = edge - trip / 2 + self._random.gauss(0.0, spread)
        return self._due - self._late
