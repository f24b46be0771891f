"""Turns on a line: one question at a time, in the order of asking; what is urgent goes before all that waits."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager


class Turns:
    """Two masters on one serial bus would talk into each other's answers: all links to a port share its turns.

    used: when the line was last used, s (monotonic).
    """

    def __init__(self) -> None:
        self._guard = threading.Lock()
        self._waiting: deque[threading.Lock] = deque()
        self._taken = False
        self.used = 0.0

    @contextmanager
    def take(self, *, urgent: bool = False, timeout: float = -1) -> Iterator[None]:
        """Wait for a turn; after `timeout` s it is taken all the same (an urgent stop must not wait for silence)."""
        held = self._begin(urgent, timeout)
        try:
            yield
        finally:
            if held:
                self._end()

    def pause(self, silence: float) -> None:
        """Keep the line silent until `silence` s after its last use."""
        wait = self.used + silence - time.monotonic()
        if wait > 0:
            time.sleep(wait)

    def _begin(self, urgent: bool, timeout: float) -> bool:
        with self._guard:
            if not self._taken:
                self._taken = True
                return True
            ticket = threading.Lock()
            ticket.acquire()
            if urgent:
                self._waiting.appendleft(ticket)
            else:
                self._waiting.append(ticket)
        if ticket.acquire(timeout=timeout):
            return True
        with self._guard:
            if ticket in self._waiting:
                self._waiting.remove(ticket)
                return False
        return True  # it was handed over in the last moment

    def _end(self) -> None:
        self.used = time.monotonic()
        with self._guard:
            if self._waiting:
                self._waiting.popleft().release()
            else:
                self._taken = False


_ports: dict[str, Turns] = {}


def turns_of(port: str) -> Turns:
    """The turns of a serial port, the same for every link of this process."""
    return _ports.setdefault(port, Turns())
