"""A simulated stand for demonstrations and tests: `python -m mocks serve` as a process of its own."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import IO, Any

from stand.errors import DeviceError, InputError, StandError

#: exit code of a program that was told something it can't use
BAD_INPUT = 2


@dataclass
class SimulatedStand:
    """Starts when entered and ends when left, or when this process is gone.

    arguments: of `python -m mocks`, the sub-command first. announcement: what it said when ready (ports,
    latencies); empty before.
    """

    arguments: Sequence[str] = ("serve",)
    log: Path | None = None
    announcement: dict[str, Any] = field(default_factory=dict)
    _process: subprocess.Popen[str] | None = None

    def __enter__(self) -> SimulatedStand:
        command = [sys.executable, "-m", "mocks", *self.arguments, "--parent", str(os.getpid())]
        errors = self.log.open("w+") if self.log else tempfile.TemporaryFile("w+")
        self._process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=errors, text=True, start_new_session=True
        )
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise self._failed(errors)
        errors.close()
        self.announcement = json.loads(line)
        return self

    def _failed(self, errors: IO[str]) -> StandError:
        assert self._process is not None
        code = self._process.wait()
        errors.seek(0)
        told = errors.read().strip().rpartition("error: ")[2][:1200]
        kind = InputError if code == BAD_INPUT else DeviceError
        return kind(
            "the simulated stand did not start", where="simulated stand", remedy=told or f"It ended with {code}"
        )

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._process is None:
            return
        self._process.terminate()
        try:
            self._process.wait(5.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        if self._process.stdout:
            self._process.stdout.close()

    def control(self, line: str) -> str:
        """Send one line to the simulated stand's control socket and return its answer without the "ok"."""
        host, _, port = str(self.announcement["control"]).rpartition(":")
        with socket.create_connection((host, int(port)), timeout=10.0) as connection:
            connection.sendall(f"{line}\n".encode())
            answer = connection.makefile().readline().strip()
        if not answer.startswith("ok"):
            raise DeviceError(f"the simulated stand refused {line!r}", where="mocks", value=answer)
        return answer.removeprefix("ok").strip()

    def mount(self, mass: float) -> None:
        """Put the added mass (kg) on the simulated weight, or take it off with 0."""
        self.control(f"added_mass {mass!r}")


def effects() -> list[str]:
    """Names of the effects of the catalogue that a simulated stand hides visibly in one short run."""
    command = [sys.executable, "-m", "mocks", "effects"]
    told = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    return [effect["name"] for effect in told if effect["catalogued"] and effect.get("visible", True)]
