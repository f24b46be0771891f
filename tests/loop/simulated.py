"""The simulated stand as a process of its own, for whole-loop tests and measurements."""

from __future__ import annotations

import contextlib
import json
import os
import select
import socket
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stand.config import Stand, load_stand


@dataclass
class Simulated:
    """announcement: what the stand said when it was ready; ledger: where it writes what it sent."""

    process: subprocess.Popen[bytes]
    announcement: dict[str, Any]
    ledger: Path

    @property
    def stand(self) -> Stand:
        """The nominal stand on this simulated one's links."""
        return load_stand().with_links(self.announcement)

    def control(self, command: str) -> str:
        """One line to the stand's control port; its answer."""
        host, _, port = str(self.announcement["control"]).rpartition(":")
        with socket.create_connection((host, int(port)), timeout=5.0) as line:
            line.sendall(command.encode() + b"\n")
            answer = line.makefile().readline().strip()
        if not answer.startswith("ok"):
            raise RuntimeError(f"{command}: {answer}")
        return answer[2:].strip()

    def statusword(self) -> int:
        """The drive's statusword, read on a connection made for it."""
        host, _, port = str(self.announcement["drive"]["tcp"]).rpartition(":")
        with socket.create_connection((host, int(port)), timeout=5.0) as line:
            line.sendall(bytes.fromhex("000100000006010313880001"))
            return int.from_bytes(line.recv(64)[9:11], "big")

    def close(self) -> None:
        """End it; what it wrote stays."""
        self.process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(10.0)
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        if self.process.stdout is not None:
            self.process.stdout.close()


@contextlib.contextmanager
def simulated_stand(*arguments: str, folder: Path | None = None) -> Iterator[Simulated]:
    """`python -m mocks serve` until the block is left."""
    with contextlib.ExitStack() as stack:
        if folder is None:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        simulated = launch(["serve", *arguments], folder / "ledger")
        stack.callback(simulated.close)
        yield simulated


def launch(arguments: Sequence[str], ledger: Path, timeout: float = 60.0) -> Simulated:
    """Start `python -m mocks ...` and wait for its announcement."""
    command = [sys.executable, "-m", "mocks", *arguments, "--parent", str(os.getpid())]
    if arguments[0] == "serve":
        command += ["--ledger", str(ledger)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, start_new_session=True, preexec_fn=_own_time)
    assert process.stdout is not None
    if not select.select([process.stdout], [], [], timeout)[0]:
        process.kill()
        raise RuntimeError("the simulated stand does not get ready")
    line = process.stdout.readline()
    if not line:
        raise RuntimeError(f"the simulated stand ended with {process.wait()}")
    return Simulated(process, json.loads(line), ledger)


def _own_time() -> None:
    """Instruments don't share the host's processor: where it is allowed, theirs goes before ordinary work."""
    with contextlib.suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(5))


__all__ = ["Simulated", "launch", "simulated_stand"]
