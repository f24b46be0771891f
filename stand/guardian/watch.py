"""The guardian's own process: it stops the drive when the acquisition falls silent, and knows nothing else.

Run as a script by `Guardian`, with an interpreter that loads no site-packages: up in some 20 ms, nothing to go wrong.
Standard input carries one byte a message: `.` alive, `A` armed, `D` disarmed, `Q` leave. The end of that pipe, or
silence for longer than the limit, while armed: every telegram is sent on a connection of the guardian's own until the
drive has answered it. It is not a safety function: that is the drive's own input and the emergency-stop circuit.
"""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import sys
import time
from typing import Any

REPLY_TIMEOUT = 0.06
GIVE_UP = 10.0
REPEAT = 0.1

#: kind "tcp" with host and port, or "serial" with the device's path as host; telegrams in hex; limit in s; report path
Order = dict[str, Any]


class Line:
    """The guardian's own way to the drive: `tcp` or a `serial` device, kept open, opened anew when it fails."""

    def __init__(self, order: Order) -> None:
        self.kind: str = order["kind"]
        self.host: str = order["host"]
        self.port: int = order.get("port", 0)
        self.handle = -1
        self.socket: socket.socket | None = None

    def open(self) -> None:
        """Connect, unless connected; OSError where that fails."""
        if self.handle >= 0:
            return
        if self.kind == "tcp":
            self.socket = socket.create_connection((self.host, self.port), timeout=0.5)
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.handle = self.socket.fileno()
        else:
            self.handle = os.open(self.host, os.O_RDWR | os.O_NOCTTY)

    def close(self) -> None:
        """Let go of the connection."""
        if self.socket is not None:
            self.socket.close()
        elif self.handle >= 0:
            os.close(self.handle)
        self.socket, self.handle = None, -1

    def ask(self, telegram: bytes, timeout: float = REPLY_TIMEOUT) -> bool:
        """True when the drive answered this telegram without an exception."""
        try:
            self.open()
            os.write(self.handle, telegram)
            if self._answer(timeout) == telegram[self._function]:
                return True
        except OSError:
            pass
        self.close()
        return False

    @property
    def _function(self) -> int:
        """Where in a telegram the function code stands."""
        return 7 if self.kind == "tcp" else 1

    def _answer(self, timeout: float) -> int:
        """The answer's function code, -1 for silence; a serial line hands over byte by byte."""
        answer, end = b"", time.monotonic() + timeout
        while len(answer) <= self._function:
            left = end - time.monotonic()
            if left <= 0 or not select.select([self.handle], [], [], left)[0]:
                return -1
            part = os.read(self.handle, 512)
            if not part:
                return -1
            answer += part
        return answer[self._function]


def stop_drive(line: Line, telegrams: list[bytes], give_up: float = GIVE_UP) -> tuple[float, float | None]:
    """The monotonic times at which the first telegram was sent and the last was answered (None: never)."""
    first = time.monotonic()
    for telegram in telegrams:
        while not line.ask(telegram):
            if time.monotonic() - first > give_up:
                return first, None
            time.sleep(0.005)
    return first, time.monotonic()


def listen(limit: float) -> tuple[str, bool]:
    """Why the watch is over, "quit", "end" (the acquisition is gone) or "silence", and whether it was armed."""
    armed = False
    while True:
        if not select.select([0], [], [], limit if armed else None)[0]:
            return "silence", armed
        message = os.read(0, 4096)
        if not message:
            return "end", armed
        for byte in message:
            if byte == ord("A"):
                armed = True
                os.write(1, b"armed\n")
            elif byte == ord("D"):
                armed = False
            elif byte == ord("Q"):
                return "quit", False


def report(path: str, why: str, first: float, confirmed: float | None) -> None:
    """Beside the run's file, for whoever looks into it later."""
    if path:
        text = {"guardian": why, "stop_sent": first, "stop_confirmed": confirmed, "utc": time.time()}
        with open(path, "w") as file:
            json.dump(text, file)


def hold(line: Line, telegrams: list[bytes]) -> None:
    """Repeat the stop until a hanging acquisition is gone: should it wake up, nothing resumes by itself."""
    while not select.select([0], [], [], REPEAT)[0] or os.read(0, 4096):
        stop_drive(line, telegrams)


def main(order: Order) -> None:
    """Watch until told to leave; stop the drive if the acquisition ends or falls silent while armed."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    line = Line(order)
    line.open()  # and kept open: a serial port whose last user is gone forgets its settings
    os.write(1, b"ready\n")
    why, armed = listen(order["limit"])
    if armed:
        telegrams = [bytes.fromhex(t) for t in order["telegrams"]]
        report(order.get("report", ""), why, *stop_drive(line, telegrams))
        if why == "silence":
            hold(line, telegrams)
    line.close()


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
