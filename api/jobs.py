"""Work after a run (comparison, diagnosis) in processes of their own, one at a time, with low priority."""

from __future__ import annotations

import builtins
import contextlib
import json
import queue
import subprocess
import sys
import tempfile
import threading
import uuid
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from api.problem import NotFound


@dataclass(frozen=True)
class Job:
    """One piece of work. state: queued, running, done, failed. fraction: 0 to 1, None where unknown."""

    id: str
    kind: str
    files: tuple[str, ...]
    options: tuple[str, ...] = ()
    state: str = "queued"
    what: str = ""
    fraction: float | None = None
    created: str = ""
    seconds: float | None = None
    result: dict[str, Any] = field(default_factory=dict)
    error: str = ""

    def view(self) -> dict[str, Any]:
        """As JSON."""
        return asdict(self)


class Jobs:
    """A queue of jobs and one worker thread that runs each in a process (`python -m api.worker`).

    changed(job) is called from the worker thread whenever a job changes. `hold` keeps new jobs back while the
    stand moves: a core that computes costs the live stream its latency.
    """

    def __init__(self, changed: Callable[[Job], None] = lambda job: None) -> None:
        self._changed = changed
        self._all: dict[str, Job] = {}
        self._queue: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._free = threading.Event()
        self._free.set()
        self._process: subprocess.Popen[str] | None = None
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="jobs", daemon=True)
        self._thread.start()

    def submit(self, kind: str, files: Sequence[Path], options: Sequence[str] = ()) -> Job:
        """Queue work on recordings."""
        now = datetime.now(UTC).isoformat(timespec="seconds")
        paths = tuple(str(file) for file in files)
        job = Job(id=uuid.uuid4().hex[:12], kind=kind, files=paths, options=tuple(options), created=now)
        self._all[job.id] = job
        self._changed(job)
        self._queue.put(job.id)
        return job

    def get(self, identity: str) -> Job:
        """The job of that id; NotFound."""
        if identity not in self._all:
            raise NotFound("no such job", where="jobs", value=identity)
        return self._all[identity]

    def list(self, kind: str | None = None) -> builtins.list[Job]:
        """All jobs, newest first."""
        return [job for job in reversed(self._all.values()) if kind in (None, job.kind)]

    def hold(self, held: bool) -> None:
        """Keep new jobs back, or let them go."""
        (self._free.clear if held else self._free.set)()

    def close(self) -> None:
        """End the running job and the worker thread."""
        self._closed = True
        self._free.set()
        self._queue.put(None)
        if self._process is not None:
            with contextlib.suppress(ProcessLookupError):
                self._process.terminate()
        self._thread.join(5.0)

    def _work(self) -> None:
        while (identity := self._queue.get()) is not None:
            self._free.wait()
            if self._closed:
                return
            self._run(self._all[identity])

    def _run(self, job: Job) -> None:
        started = datetime.now(UTC)
        job = self._tell(replace(job, state="running"))
        command = [sys.executable, "-m", "api.worker", job.kind, *job.options, *job.files]
        with tempfile.TemporaryFile("w+") as errors:
            self._process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True)
            job = self._follow(job, self._process)
            code = self._process.wait()
            errors.seek(0)
            message = errors.read().strip().splitlines()[-1:] or [f"ended with code {code}"]
        job = replace(job, seconds=(datetime.now(UTC) - started).total_seconds())
        if code == 0:
            self._tell(replace(job, state="done", fraction=1.0))
        else:
            self._tell(replace(job, state="failed", error=message[0].removeprefix("stand: ")))

    def _follow(self, job: Job, process: subprocess.Popen[str]) -> Job:
        assert process.stdout is not None
        for line in process.stdout:
            with contextlib.suppress(json.JSONDecodeError):
                told = json.loads(line)
                result = told.get("result", job.result)
                job = self._tell(
                    replace(job, what=told.get("what", job.what), fraction=told.get("fraction"), result=result)
                )
        return job

    def _tell(self, job: Job) -> Job:
        self._all[job.id] = job
        self._changed(job)
        return job
