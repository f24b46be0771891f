"""The thread of a reader, which can be started again."""

from __future__ import annotations

import threading
from collections.abc import Callable

#: s that a thread is waited for
PATIENCE = 2.0


class Worker:
    """One thread at a time; its work asks `stopping` whether to go on. name: of the thread."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._thread: threading.Thread | None = None
        self.stopping = threading.Event()

    @property
    def at_work(self) -> bool:
        """Between `start` and `stop`."""
        return self._thread is not None

    def start(self, work: Callable[..., None], *given: object) -> None:
        """Call `work` in a new thread."""
        self.stopping.clear()
        self._thread = threading.Thread(target=work, args=given, name=self._name, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Ask it to end and wait; harmless twice, and from the thread itself."""
        self.stopping.set()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join(PATIENCE)
        self._thread = None
