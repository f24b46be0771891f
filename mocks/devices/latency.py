"""How quickly a host on the same machine hears: `python -m mocks.devices.latency HOST PORT UNIT` or `... TERMINAL`.

A host puts the drive's look at itself in the middle between its request and the answer's coming in, which the kernel
notes. What the two legs differ by is the link's fixed latency: half of it is how much too late the samples then seem.
A serial port's bytes pass through the system, too, before a host has them.
"""

from __future__ import annotations

import json
import os
import select
import socket
import statistics
import struct
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

from mocks.wire.terminal import Terminal

TRIES, PAUSE, QUICK = 150, 7e-4, 0.3
#: Linux's option to note when a packet came (SO_TIMESTAMPNS)
STAMPS = 35


@dataclass(frozen=True, slots=True)
class Legs:
    """s: from the request sent to the drive's look at itself, and from that to the whole answer."""

    request: float
    answer: float

    @property
    def fixed(self) -> float:
        """How much later than taken a sample seems that is placed in the middle."""
        return (self.answer - self.request) / 2.0


def drive_latency(host: str, port: int, unit: int, looks: list[float]) -> Legs:
    """The legs' medians over the quickest reads of a host of its own; `looks` collects when the drive looked."""
    looks.clear()
    command = [sys.executable, "-m", "mocks.devices.latency", host, str(port), str(unit)]
    told = subprocess.run(command, capture_output=True, check=True, timeout=20.0, text=True).stdout
    reads = [(q, look, p) for q, p in json.loads(told) for look in looks if q < look < p]
    quickest = sorted(reads, key=lambda read: read[2] - read[0])[: int(QUICK * len(reads))]
    return Legs(*(statistics.median(r[k + 1] - r[k] for r in quickest) for k in (0, 1)))


def port_latency(terminal: Terminal) -> float:
    """From bytes handed over to a host of its own that has them, s: median of the quickest."""
    command = [sys.executable, "-m", "mocks.devices.latency", str(terminal.port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as host:
        assert host.stdout is not None
        host.stdout.readline()
        sent = []
        for _ in range(TRIES):
            time.sleep(PAUSE)
            sent.append(time.monotonic())
            terminal.write(b"\xaa" * 8)
        terminal.disconnect()
        came: list[float] = json.loads(host.stdout.readline())
    took = [min((t - s for t in came if t > s), default=1.0) for s in sent]
    return statistics.median(sorted(took)[: int(QUICK * len(took))])


def listen(port: str) -> list[float]:
    """When bytes came at a serial port, until it hangs up."""
    descriptor, came = os.open(port, os.O_RDWR | os.O_NOCTTY), []
    print("ready", flush=True)
    with suppress(OSError):
        while select.select([descriptor], [], [], 5.0)[0] and os.read(descriptor, 4096):
            came.append(time.monotonic())
    os.close(descriptor)
    return came


def ask(host: str, port: int, unit: int) -> list[tuple[float, float]]:
    """(asked, answered) of TRIES reads of the ring."""
    request = struct.pack(">HHHBBHH", 1, 0, 6, unit, 3, 2000, 64)
    found = []
    with socket.create_connection((host, port), timeout=5.0) as link:
        link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        link.setsockopt(socket.SOL_SOCKET, STAMPS, 1)
        for _ in range(TRIES):
            time.sleep(PAUSE)
            asked = time.monotonic()
            link.sendall(request)
            size = 0
            while size < 9 + 128:
                data, notes, _, _ = link.recvmsg(512, 64)
                heard = time.monotonic() - since(notes)
                size += len(data)
            found.append((asked, heard))
    return found


def since(notes: Sequence[tuple[int, int, bytes]]) -> float:
    """How long ago the network had the bytes that came with these notes, s; 0 where no note tells."""
    now = time.time()
    stamps = [struct.unpack_from("@ll", data) for _, kind, data in notes if kind == STAMPS]
    return max(0.0, now - stamps[0][0] - stamps[0][1] * 1e-9) if stamps else 0.0


def main(arguments: Sequence[str]) -> None:
    """Prints the times as JSON."""
    if len(arguments) == 1:
        print(json.dumps(listen(arguments[0])))
    else:
        host, port, unit = arguments
        print(json.dumps(ask(host, int(port), int(unit))))


if __name__ == "__main__":
    main(sys.argv[1:])
