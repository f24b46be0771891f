"""The quick stop: prepared telegrams on a connection of its own, sent by a thread of its own."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext

from stand.guardian.client import StopOrder
from stand.guardian.watch import Line, stop_drive
from stand.transport.turns import turns_of

SLOWEST = 0.1
#: s that a question and its answer take on a slow bus; a drive that is silent for longer is not waited for
LONGEST_QUESTION = 0.05


class QuickStop:
    """Connected before anything moves; `trigger` is safe to call from any thread and any number of times.

    The stop is repeated, from every `repeat` s to every SLOWEST s, until `close`, so that a set point already on
    its way can't undo it.
    """

    def __init__(self, order: StopOrder, *, repeat: float = 0.005) -> None:
        self._order, self._repeat = order, repeat
        self._line = Line({"kind": order.kind, "host": order.host, "port": order.port})
        self._wanted, self._leave = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._serve, name="quick-stop", daemon=True)
        self.confirmed = threading.Event()
        self.sent_at: float | None = None
        self.on_sent: Callable[[float], None] = lambda _sent: None

    def start(self) -> None:
        """Connect; OSError where the drive accepts no further connection."""
        self._line.open()
        self._thread.start()

    def trigger(self) -> None:
        """Stop the drive now."""
        self._wanted.set()

    def close(self) -> None:
        """Let go of the connection; a stop that is being repeated ends."""
        self._leave.set()
        self._wanted.set()
        if self._thread.is_alive():
            self._thread.join(1.0)
        self._line.close()

    def _turn(self) -> AbstractContextManager[None]:
        """On a serial bus, the next turn: after the question under way, before all others."""
        if self._order.kind == "tcp":
            return nullcontext()
        return turns_of(self._order.host).take(urgent=True, timeout=LONGEST_QUESTION)

    def _serve(self) -> None:
        self._wanted.wait()
        while not self._leave.is_set():
            with self._turn():
                first, answered = stop_drive(self._line, list(self._order.telegrams))
            if self.sent_at is None:
                self.sent_at = first
                self.on_sent(first)
            if answered is not None:
                self.confirmed.set()
            self._leave.wait(self._repeat)
            self._repeat = min(1.3 * self._repeat, SLOWEST)
