"""Starting the acquisition process and listening to it."""

from __future__ import annotations

import contextlib
import os
import queue
import subprocess
import sys
import threading
from collections.abc import Iterator
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path

from stand.clock.model import LiveBlock
from stand.config import Stand
from stand.guardian.watch import Line, stop_drive
from stand.runs.link import StopRequest, is_last
from stand.runs.messages import Failed, Finished, Health, Phase, Progress
from stand.runs.order import Order
from stand.runs.priority import ordinary_children
from stand.runs.stopping import stop_order
from stand.safety.trip import Trip

Event = Phase | LiveBlock | Progress | Health | Trip | Finished | Failed


def start(stand: Stand, order: Order) -> RunHandle:
    """Start the acquisition process on this order; returns at once, what goes wrong comes as `Failed`."""
    ours, theirs = Pipe()
    ordinary_children()
    command = [sys.executable, "-m", "stand.runs", str(theirs.fileno()), str(os.getpid())]
    process = subprocess.Popen(
        command, pass_fds=(theirs.fileno(),), stdin=subprocess.DEVNULL, start_new_session=True, cwd=Path.cwd()
    )
    theirs.close()
    with contextlib.suppress(OSError):  # it died at once: `events` says so
        ours.send((stand, order))
    return RunHandle(stand, process, ours)


class RunHandle:
    """A running acquisition. If this process ends, the acquisition stops the drive and closes the recording."""

    def __init__(self, stand: Stand, process: subprocess.Popen[bytes], connection: Connection) -> None:
        self._stand, self._process, self._connection = stand, process, connection
        self._events: queue.SimpleQueue[Event | None] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self.last: Finished | Failed | None = None
        threading.Thread(target=self._listen, name="run-events", daemon=True).start()

    @property
    def pid(self) -> int:
        """Of the acquisition process."""
        return self._process.pid

    def events(self) -> Iterator[Event]:
        """Every event in order, blocking, up to and including `Finished` or `Failed`. For one reader."""
        while (event := self._events.get()) is not None:
            yield event
        self._events.put(None)

    def wait(self) -> Finished | Failed:
        """Pass over all events; the last one."""
        for _ in self.events():
            pass
        assert self.last is not None
        return self.last

    def stop(self, reason: str = "stopped by the operator") -> None:
        """End the run in good order: the motion slows down, the recording is closed."""
        self._send(StopRequest(reason))

    def emergency_stop(self, reason: str = "emergency stop by the operator") -> bool:
        """Quick stop now: told to the acquisition, and sent from here as well; True when the drive has answered."""
        self._send(StopRequest(reason, emergency=True))
        return emergency_stop(self._stand)

    def poll(self) -> int | None:
        """The process's exit code, None while it runs."""
        return self._process.poll()

    def _send(self, message: StopRequest) -> None:
        with self._lock, contextlib.suppress(OSError):
            self._connection.send(message)

    def _listen(self) -> None:
        while self.last is None:
            try:
                event = self._connection.recv()
            except (EOFError, OSError):
                event = self._death()
            if is_last(event):
                self.last = event
            self._events.put(event)
        self._process.wait()
        self._connection.close()
        self._events.put(None)

    def _death(self) -> Failed:
        code = self._process.wait()
        what = f"the acquisition process died (exit code {code})"
        remedy = "The guardian has stopped the drive; `stand doctor --recover FILE` redoes the recording"
        return Failed("DeviceError", what, remedy=remedy)


def emergency_stop(stand: Stand) -> bool:
    """Quick stop from this very process, on a connection made for it; True when the drive has answered."""
    order = stop_order(stand)
    line = Line({"kind": order.kind, "host": order.host, "port": order.port})
    try:
        return stop_drive(line, list(order.telegrams), give_up=1.0)[1] is not None
    finally:
        line.close()
