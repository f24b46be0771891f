"""A simulated stand as a process, for tests that meet it on its wires."""

from __future__ import annotations

import json
import os
import select
import socket
import subprocess
import sys
import time
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any


@contextmanager
def process(*arguments: str | Path) -> Iterator[dict[str, Any]]:
    """`python -m mocks ...` from its announcement on until the block is left."""
    command = [sys.executable, "-m", "mocks", *map(str, arguments), "--parent", str(os.getpid())]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert running.stdout is not None
    assert running.stderr is not None
    line = running.stdout.readline()
    if not line:
        raise AssertionError(running.stderr.read())
    try:
        yield json.loads(line)
    finally:
        running.terminate()
        code = running.wait(10.0)
        errors = running.stderr.read()
        running.stdout.close()
        running.stderr.close()
        assert code == 0, errors


class Port:
    """A serial port opened raw; what arrives is kept with its arrival times."""

    def __init__(self, path: str) -> None:
        self.descriptor = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.descriptor)
        self.data, self.arrivals = bytearray(), list[tuple[float, int]]()

    def read_until(self, enough: Callable[[], bool], timeout: float = 10.0) -> bytes:
        """Everything so far, once it is enough; AssertionError after the timeout."""
        end = time.monotonic() + timeout
        while not enough():
            assert time.monotonic() < end, f"only {len(self.data)} bytes: {bytes(self.data[-60:])!r}"
            if select.select([self.descriptor], [], [], 0.1)[0]:
                data = os.read(self.descriptor, 65536)
                if not data:
                    raise OSError("hung up")
                self.data += data
                self.arrivals.append((time.monotonic(), len(data)))
        return bytes(self.data)

    def read_what_is_there(self) -> None:
        """Without waiting."""
        if select.select([self.descriptor], [], [], 0.0)[0]:
            self.data += os.read(self.descriptor, 65536)

    def read_bytes(self, count: int) -> bytes:
        """At least so many."""
        return self.read_until(lambda: len(self.data) >= count)

    def ask(self, request: bytes, answer: Callable[[bytes], bool]) -> bytes:
        """Send, then read until the answer is among what came."""
        self.data.clear()
        os.write(self.descriptor, request)
        return self.read_until(lambda: answer(bytes(self.data)))

    def close(self) -> None:
        os.close(self.descriptor)


@contextmanager
def opened(path: str) -> Iterator[Port]:
    """A port for the length of a block."""
    port = Port(path)
    try:
        yield port
    finally:
        port.close()


def command(announcement: dict[str, Any], line: str) -> str:
    """A line of the control protocol and its answer."""
    host, _, number = announcement["control"].rpartition(":")
    with socket.create_connection((host, int(number)), timeout=5.0) as link:
        link.sendall(line.encode() + b"\n")
        return link.makefile().readline().strip()


def exchange(announcement: dict[str, Any], request: bytes) -> bytes:
    """A raw Modbus TCP telegram and the answer to it."""
    host, _, number = announcement["drive"]["tcp"].rpartition(":")
    with socket.create_connection((host, int(number)), timeout=5.0) as link:
        link.sendall(request)
        return link.recv(512)
