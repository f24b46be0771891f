"""What ends a run early, whoever asks for it."""

from __future__ import annotations

import threading
import time
from multiprocessing.connection import Connection

from stand.runs.link import StopRequest
from stand.safety import Supervisor, Trip


class Halt:
    """An event with a reason: the motion thread asks `wanted`, sleeps with `wait`."""

    def __init__(self) -> None:
        self._event, self.reason = threading.Event(), ""

    def want(self, reason: str) -> None:
        """End the run; the first reason stays."""
        if not self._event.is_set():
            self.reason = reason
        self._event.set()

    def wanted(self) -> bool:
        """True when the run is to end."""
        return self._event.is_set()

    def wait(self, seconds: float) -> bool:
        """Sleep, but not longer than until the run is to end; True if it is."""
        return self._event.wait(max(seconds, 0.0))


def obey(connection: Connection, halt: Halt, supervisor: Supervisor) -> None:
    """Listen to whoever started the run until that process ends, which stops the run, too. For a thread."""
    while True:
        try:
            request = connection.recv()
        except (EOFError, OSError):
            what = "the process that started the run is gone"
            supervisor.raise_trip(Trip("operator", what, arrival=time.monotonic()))
            return
        if isinstance(request, StopRequest) and request.emergency:
            supervisor.raise_trip(Trip("operator", request.reason, arrival=time.monotonic()))
        elif isinstance(request, StopRequest):
            halt.want(request.reason)
