"""How long the drive's server takes, seen from a host on the same machine."""

from __future__ import annotations

import socket
import struct
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Legs:
    """Least times, s: from the request sent to the drive's look at itself, and from that to the whole answer."""

    request: float
    answer: float


def drive_latency(host: str, port: int, unit: int, looked: Callable[[], float], tries: int = 60) -> Legs:
    """Reads the ring `tries` times; looked() tells when the drive looked at itself for the last request."""
    request = struct.pack(">HHHBBHH", 1, 0, 6, unit, 3, 2000, 64)
    found = []
    with socket.create_connection((host, port), timeout=5.0) as link:
        link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for _ in range(tries):
            time.sleep(1e-3)
            asked = time.monotonic()
            link.sendall(request)
            _whole(link, 9 + 128)
            found.append((looked() - asked, time.monotonic() - looked()))
    return Legs(min(leg[0] for leg in found), min(leg[1] for leg in found))


def _whole(link: socket.socket, size: int) -> bytes:
    data = b""
    while len(data) < size:
        data += link.recv(512)
    return data
