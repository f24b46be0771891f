"""A long run under load: is any sample lost, and how late is the live stream?

`python -m tests.loop.soak --minutes 10`: 2 kHz through the server, which is polled 50 times a second while a WebSocket
client is attached and another process keeps one core busy. Judged by value against the simulated stand's ledger.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from api.priority import first
from tests.loop.ledger import await_sample, gauge_values, ring_values
from tests.loop.simulated import Simulated, simulated_stand

POLLS = 50.0
TOKEN = "only-for-this-measurement"
LATENCY_LIMIT = 0.1


@dataclass
class Server:
    """The server under load: polled, watched, and asked for one experiment."""

    address: str
    polls: int = 0
    latencies: list[float] = field(default_factory=list)
    arrivals: list[float] = field(default_factory=list)
    dropped: int = 0
    leave: threading.Event = field(default_factory=threading.Event)

    def ask(self, path: str, order: dict[str, Any] | None = None) -> Any:
        """The JSON answer to a GET, or to a POST of an order."""
        data = None if order is None else json.dumps(order).encode()
        headers = {"Authorization": f"Bearer {TOKEN}", "Content-Type": "application/json"}
        request = urllib.request.Request(self.address + path, data, headers)
        with urllib.request.urlopen(request, timeout=30) as answer:
            return json.load(answer)

    def poll(self) -> None:
        """POLLS times a second, until told to leave."""
        due = time.monotonic()
        while not self.leave.wait(max(0.0, due - time.monotonic())):
            due += 1.0 / POLLS
            self.ask("/stand")
            self.polls += 1

    def watch(self) -> None:
        """Follow the live stream as a page does."""
        first()  # what measures must not be late itself
        address = self.address.replace("http", "ws", 1) + "/live"
        with contextlib.suppress(ConnectionClosed), connect(address, max_size=None) as socket:
            while not self.leave.is_set():
                with contextlib.suppress(TimeoutError):
                    self._note(json.loads(socket.recv(timeout=0.5)))

    def _note(self, message: dict[str, Any]) -> None:
        if "arrival" in message:
            self.latencies.append(time.monotonic() - message["arrival"])
            self.arrivals.append(message["arrival"])
        elif message.get("type") == "dropped":
            self.dropped = message["blocks"]


@contextlib.contextmanager
def serving(simulated: Simulated, folder: Path) -> Iterator[Server]:
    """The server on this simulated stand, polled and watched."""
    (folder / "stand.toml").write_text(simulated.stand.to_toml())
    (folder / "token").write_text(TOKEN)
    command = [sys.executable, "-m", "api.cli", "serve", "--stand", str(folder / "stand.toml"), "--port", "0"]
    command += ["--token-file", str(folder / "token"), "--out", str(folder / "runs")]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    server = Server(process.stdout.readline().strip().rstrip("/"))
    threads = [threading.Thread(target=work, daemon=True) for work in (server.poll, server.watch)]
    try:
        _await_answer(server)
        for thread in threads:
            thread.start()
        yield server
    finally:
        server.leave.set()
        process.terminate()
        process.wait()
        process.stdout.close()


def _await_answer(server: Server, timeout: float = 30.0) -> None:
    deadline = time.monotonic() + timeout
    while True:
        try:
            server.ask("/stand")
            return
        except OSError:
            if time.monotonic() > deadline:
                raise
            time.sleep(0.1)


@contextlib.contextmanager
def busy_core() -> Iterator[None]:
    """Another process that never rests."""
    process = subprocess.Popen(
        [sys.executable, "-c", "import os; os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))\nwhile 1: pass"]
    )
    try:
        yield
    finally:
        process.kill()
        process.wait()


def run(server: Server, seconds: float) -> dict[str, Any]:
    """One experiment of `seconds` of motion; its view once it is over."""
    order = {"shape": "trapezoidal", "frequency": 1.25, "amplitude": 0.03, "ramp": 0.2, "duration": seconds}
    made: dict[str, Any] = server.ask("/experiments", order)
    deadline = time.monotonic() + 1.2 * seconds + 120.0
    while (view := server.ask(made["links"]["self"]))["run"] is None or view["streaming"]:
        if view["why"] or time.monotonic() > deadline:
            break
        time.sleep(0.5)
    return view


def lost_samples(path: Path, ledger: Path) -> dict[str, tuple[int, int]]:
    """instrument -> (samples that the stand sent between the first and the last recorded one, those missing here)."""
    found = {}
    with h5py.File(path, "r") as file:
        await_sample(ledger, int(file["entry/instruments/drive/ticks"][-1]))
        for name in ("force_gauge", "dial_gauge"):
            recorded = file[f"entry/instruments/{name}/values"][()]
            found[name] = _missing(recorded, gauge_values(ledger, name))
        drive = file["entry/instruments/drive"]
        sent = ring_values(ledger)
        ticks, values = drive["ticks"][()], drive["values"][()]
        wrong = sum(abs(sent.get(tick, np.inf) - value) > 1e-9 for tick, value in zip(ticks, values, strict=True))
        found["drive"] = (int(ticks[-1] - ticks[0]) + 1, int(ticks[-1] - ticks[0]) + 1 - len(set(ticks)) + int(wrong))
    return found


def _missing(recorded: np.ndarray, sent: np.ndarray) -> tuple[int, int]:
    """Walk both sequences: whatever was sent and is not recorded in its place is missing."""
    probe = recorded[:64]
    windows = np.lib.stride_tricks.sliding_window_view(sent, len(probe))
    start = int(np.argmin(np.abs(windows - probe).max(axis=1)))
    same = sent[start : start + len(recorded)]
    if len(same) == len(recorded) and np.abs(same - recorded).max() < 1e-9:
        return len(recorded), 0
    missing, at = 0, start
    for value in recorded:
        while at < len(sent) and abs(sent[at] - value) > 1e-9:
            at, missing = at + 1, missing + 1
        at += 1
    return at - start, missing


def main() -> int:
    """Run, judge, and fail on a lost sample or a late stream."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    options = parser.parse_args()
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        simulated = stack.enter_context(simulated_stand(folder=folder))
        server = stack.enter_context(serving(simulated, folder))
        stack.enter_context(busy_core())
        view = run(server, 60.0 * options.minutes)
        if view["run"] is None:
            print(f"no recording: {view['state']} {view['why']}")
            return 1
        path = folder / "runs" / f"{view['run']}.h5"
        while not path.exists() or not _complete(path):
            time.sleep(0.5)
        print(_longest(path))
        return _judge(view, server, lost_samples(path, simulated.ledger))


def _longest(path: Path) -> str:
    """The longest time between two polls of the drive's ring, and what of it was the first one's answer."""
    with h5py.File(path, "r") as file:
        drive, origin = file["entry/instruments/drive"], float(file["entry/data"].attrs["host_origin"])
        asked, answered = drive["request_time"][()], drive["response_time"][()]
    k = int(np.argmax(np.diff(asked)))
    apart, took = asked[k + 1] - asked[k], answered[k] - asked[k]
    return (
        f"drive: polls at most {apart * 1e3:.0f} ms apart, {asked[k] - origin:.1f} s in; {took * 1e3:.0f} ms its answer"
    )


def _complete(path: Path) -> bool:
    with contextlib.suppress(OSError, KeyError), h5py.File(path, "r") as file:
        return bool(file["entry/events"].attrs["complete"])
    return False


def _judge(view: dict[str, Any], server: Server, lost: dict[str, tuple[int, int]]) -> int:
    late = np.percentile(server.latencies, [50, 99, 100]) * 1e3
    print(f"the run: {view['state']} {view['why'] or ''}; API answered {server.polls} polls")
    for name, (sent, missing) in lost.items():
        print(f"{name}: {sent} samples sent, {missing} lost")
    print(
        f"live: median {late[0]:.0f} ms, 99 % {late[1]:.0f} ms, worst {late[2]:.0f} ms; {server.dropped} blocks dropped"
    )
    if view["latency"]:
        told = {name: f"{value * 1e3:.0f} ms" for name, value in view["latency"].items() if name != "blocks"}
        print(f"as the server saw it, oldest sample to published: {told}")
    begun = np.array(server.arrivals) - server.arrivals[0]
    behind = begun[np.array(server.latencies) > LATENCY_LIMIT]
    if len(behind):
        print(f"late blocks: {len(behind)} of {len(begun)}, from {behind[0]:.1f} to {behind[-1]:.1f} s after the first")
    good = not any(missing for _, missing in lost.values()) and late[1] < LATENCY_LIMIT * 1e3 and not view["why"]
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
