"""Starting, feeding and dismissing the guardian from inside the acquisition."""

from __future__ import annotations

import contextlib
import json
import os
import select
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from stand.errors import DeviceError
from stand.guardian import watch

BEAT = 0.02
SILENCE_LIMIT = 0.2


@dataclass(frozen=True, slots=True)
class StopOrder:
    """How to stop the drive without knowing it: kind "tcp" or "serial", host or device path, port, telegrams."""

    kind: str
    host: str
    port: int
    telegrams: tuple[bytes, ...]


class Guardian:
    """Armed, it stops the drive when this process dies, or hangs for longer than `limit` seconds."""

    def __init__(self, order: StopOrder, *, limit: float = SILENCE_LIMIT, report: Path | None = None) -> None:
        self._order, self._limit, self._report = order, limit, report
        self._process: subprocess.Popen[bytes] | None = None
        self._pipe = -1
        self._leave = threading.Event()
        self.last_beat = time.monotonic()

    @property
    def pid(self) -> int:
        """Of the guardian's process; 0 before `start`."""
        return self._process.pid if self._process else 0

    def start(self) -> None:
        """Start it in a session of its own and wait until it is connected; DeviceError where it can't connect."""
        command = [sys.executable, "-I", "-S", "-B", watch.__file__, json.dumps(self._text())]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True
        )
        assert self._process.stdin is not None
        self._pipe = self._process.stdin.fileno()
        self._expect(b"ready")
        threading.Thread(target=self._beat, name="guardian-beat", daemon=True).start()

    def arm(self) -> None:
        """From here on the end of this process stops the drive; DeviceError where the guardian doesn't confirm."""
        self._send(b"A")
        self._expect(b"armed")

    def disarm(self) -> None:
        """The drive rests: the end of this process is harmless."""
        self._send(b"D")

    def check(self) -> str | None:
        """Why this process may move nothing: the guardian is gone, or was last told of life too long ago."""
        if self._process is None or self._process.poll() is not None:
            return "the guardian process is gone"
        silent = time.monotonic() - self.last_beat
        return f"no heartbeat for {silent:.3f} s" if silent > self._limit else None

    def close(self) -> None:
        """Dismiss the guardian; it leaves without stopping anything."""
        self._leave.set()
        if self._process is None:
            return
        with contextlib.suppress(OSError):
            os.write(self._pipe, b"DQ")
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(1.0)
        for stream in (self._process.stdin, self._process.stdout):
            with contextlib.suppress(OSError):
                stream.close()  # type: ignore[union-attr]

    def _text(self) -> dict[str, object]:
        telegrams: Sequence[str] = [t.hex() for t in self._order.telegrams]
        text: dict[str, object] = {"kind": self._order.kind, "host": self._order.host, "port": self._order.port}
        return text | {"telegrams": telegrams, "limit": self._limit, "report": str(self._report or "")}

    def _beat(self) -> None:
        while not self._leave.wait(BEAT):
            try:
                os.write(self._pipe, b".")
            except OSError:
                return
            self.last_beat = time.monotonic()

    def _send(self, message: bytes) -> None:
        try:
            os.write(self._pipe, message)
        except OSError as error:
            raise DeviceError("is gone", where="guardian", remedy="Start the run again; nothing was moved") from error

    def _expect(self, word: bytes, timeout: float = 3.0) -> None:
        assert self._process is not None
        assert self._process.stdout is not None
        ready = select.select([self._process.stdout], [], [], timeout)[0]
        if not ready or os.read(self._process.stdout.fileno(), 64).strip() != word:
            remedy = "Check that the drive accepts one more Modbus connection"
            raise DeviceError(f"did not say {word.decode()!r}", where="guardian", remedy=remedy)
