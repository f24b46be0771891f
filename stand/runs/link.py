"""The one socket between the acquisition and whoever started it: whole messages, both ways."""

from __future__ import annotations

import copyreg
import queue
import threading
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from types import MappingProxyType
from typing import Any

from stand.clock.model import LiveBlock
from stand.runs.messages import Failed, Finished, Progress

#: live blocks that may wait for a slow reader, before further ones are dropped
LIVE_WAITING = 100


def _pickle_proxy(proxy: MappingProxyType[Any, Any]) -> tuple[Any, tuple[dict[Any, Any]]]:
    return MappingProxyType, (dict(proxy),)


copyreg.pickle(MappingProxyType, _pickle_proxy)


@dataclass(frozen=True, slots=True)
class StopRequest:
    """End the run early: in good order, or by quick stop."""

    reason: str
    emergency: bool = False


class Tap:
    """Sends messages from any thread; live blocks may be dropped when the reader is slow, and are counted."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._queue: queue.SimpleQueue[object] = queue.SimpleQueue()
        self._waiting, self._lock = 0, threading.Lock()
        self.published, self.dropped = 0, 0
        self.broken = threading.Event()
        self._thread = threading.Thread(target=self._serve, name="tap", daemon=True)
        self._thread.start()

    def send(self, message: object) -> None:
        """Queue a message; never blocks. A live block is dropped if too many wait."""
        if isinstance(message, LiveBlock):
            with self._lock:
                if self._waiting >= LIVE_WAITING:
                    self.dropped += 1
                    return
                self._waiting += 1
        if isinstance(message, Progress):
            message = replace(message, published=self.published, dropped=self.dropped)
        self._queue.put(message)

    def close(self, timeout: float = 2.0) -> None:
        """Send what waits, then end."""
        self._queue.put(None)
        self._thread.join(timeout)

    def _serve(self) -> None:
        while (message := self._queue.get()) is not None:
            try:
                self._connection.send(message)
            except OSError:
                self.broken.set()
            if isinstance(message, LiveBlock):
                with self._lock:
                    self._waiting -= 1
                    self.published += 1


def is_last(message: object) -> bool:
    """True for the message after which nothing follows."""
    return isinstance(message, Finished | Failed)
