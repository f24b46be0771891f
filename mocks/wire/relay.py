"""A two-wire serial bus between two pseudo-terminals: bytes reach the other end at the baud rate."""

from __future__ import annotations

import os
import select
import threading
import time
import tty
from pathlib import Path

from mocks.wire.terminal import Terminal

BITS = 11.0


class Relay(threading.Thread):
    """host: the terminal that the host opens. device: the name of the port that the device's server opens."""

    def __init__(self, folder: Path, name: str, baud: int) -> None:
        super().__init__(name=f"relay {name}", daemon=True)
        self.host = Terminal(folder, name)
        self._near, far = os.openpty()
        tty.setraw(far)
        self._far, self.device = far, os.ttyname(far)
        self.byte_time = BITS / baud
        self._ending = False

    def run(self) -> None:
        """Until `end`."""
        while not self._ending:
            held, _ = self.host.watched()
            listened = [self._near, self.host.fileno()] if held else [self._near]
            ready, _, _ = select.select(listened, [], [], 0.05)
            if self.host.fileno() in ready:
                self._pass(self.host.fileno(), self._near)
            if self._near in ready:
                self._pass(self._near, self.host.fileno() if held else -1)

    def _pass(self, source: int, sink: int) -> None:
        """What came goes on when its last byte would have arrived."""
        try:
            data = os.read(source, 512)
            time.sleep(len(data) * self.byte_time)
            if sink >= 0:
                os.write(sink, data)
        except OSError:
            return

    def end(self) -> None:
        """Stop and wait."""
        self._ending = True
        self.join()
        self.host.disconnect()
        for end in (self._near, self._far):
            os.close(end)
