"""A pseudo-terminal that behaves like a serial port: what is sent while nobody has it open is gone."""

from __future__ import annotations

import os
import select
import termios
import tty
from contextlib import suppress
from pathlib import Path


class Terminal:
    """One port under a name that stays when the line is broken and joined again.

    port: a symbolic link in `folder` to the terminal's name.
    """

    def __init__(self, folder: Path, name: str) -> None:
        self.port = folder / name
        self._master = -1
        self._raw = False
        self.connect()

    def connect(self) -> None:
        """Join the line; nothing happens where it is joined."""
        if self._master >= 0:
            return
        self._master, slave = os.openpty()
        os.set_blocking(self._master, False)
        tty.setraw(slave)
        fresh = self.port.with_suffix(".new")
        fresh.unlink(missing_ok=True)
        fresh.symlink_to(os.ttyname(slave))
        fresh.rename(self.port)
        os.close(slave)
        self._poll = select.poll()
        self._poll.register(self._master, select.POLLIN)
        self._raw = False

    def disconnect(self) -> None:
        """Break the line: a reader gets a hang-up, a new one finds no port."""
        self.port.unlink(missing_ok=True)
        if self._master >= 0:
            os.close(self._master)
            self._master = -1

    def fileno(self) -> int:
        """The device's end; -1 while broken."""
        return self._master

    def watched(self) -> tuple[bool, bool]:
        """Whether a host has it open, and whether it sent something."""
        if self._master < 0:
            return False, False
        events = self._poll.poll(0)
        flags = events[0][1] if events else 0
        held = not flags & (select.POLLHUP | select.POLLERR)
        if held and not self._raw:
            with suppress(termios.error):
                tty.setraw(self._master, termios.TCSANOW)
        self._raw = held
        return held, bool(flags & select.POLLIN)

    def read(self) -> bytes:
        """What the host sent."""
        try:
            return os.read(self._master, 4096)
        except OSError:
            return b""

    def write(self, data: bytes) -> int:
        """How many bytes the host's side took; fewer than given where its buffer is full."""
        try:
            return os.write(self._master, data)
        except OSError:
            return 0
