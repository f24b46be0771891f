"""A real server with a simulated stand behind it, as subprocesses, on ports that the system gives."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest
from websockets.sync.client import connect

from stand.config import Stand, load_stand

#: short and gentle: two cycles of 5 mm
ORDER = {"shape": "trapezoidal", "frequency": 2.0, "amplitude": 0.005, "ramp": 0.15, "cycles": 2}
ENDS = {"finished", "stopped", "tripped", "emergency-stopped", "failed"}


@dataclass
class Server:
    """url without the token; folder of runs; http: a client that shows the token."""

    url: str
    token: str
    folder: Path
    http: httpx.Client

    def order(self, **changes: Any) -> dict[str, Any]:
        """Start an experiment; its view."""
        answer = self.http.post("/experiments", json={**ORDER, **changes})
        assert answer.status_code == 201, answer.text
        view: dict[str, Any] = answer.json()
        return view

    def until(self, path: str, met: Callable[[Any], bool], seconds: float = 40.0) -> Any:
        """The answer to GET path, once it is as wanted."""
        end = time.monotonic() + seconds
        while not met(found := self.http.get(path).json()):
            assert time.monotonic() < end, f"{path} is still {json.dumps(found)[:1500]}"
            time.sleep(0.05)
        return found

    def ended(self, identity: str) -> dict[str, Any]:
        """The experiment's view after its end."""
        view: dict[str, Any] = self.until(f"/experiments/{identity}", lambda e: e["state"] in ENDS)
        return view

    def listen(self, **options: Any) -> Any:
        """A WebSocket on the live stream."""
        return connect(self.url.replace("http", "ws") + "/live", **options)


def patient(stand: Stand) -> Stand:
    """The same stand, patient with a machine that has other tests to run: no trip for a late read."""
    parts = {name: part.model_copy(update={"stale": 3.0}) for name, part in stand.instruments.items()}
    link = stand.drive.link.model_copy(update={"timeout": 3.0})
    parts["drive"] = parts["drive"].model_copy(update={"link": link})
    return stand.model_copy(update=parts)


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    folder = tmp_path_factory.mktemp("runs")
    (folder / "stand.toml").write_text(patient(load_stand()).to_toml())
    options = [
        "--simulated",
        "--no-diagnose",
        "--stand",
        str(folder / "stand.toml"),
        "--seed",
        "1",
        "--port",
        "0",
        "--out",
        str(folder),
    ]
    command = [sys.executable, "-m", "api.cli", "serve", *options]
    with (folder / "server.log").open("w") as log:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True)
    assert process.stdout is not None
    parts = urlsplit(process.stdout.readline().strip())
    assert parts.scheme == "http", (folder / "server.log").read_text()
    url, token = f"http://{parts.netloc}", parse_qs(parts.query)["token"][0]
    with httpx.Client(base_url=url, headers={"Authorization": f"Bearer {token}"}, timeout=30.0) as http:
        found = Server(url, token, folder, http)
        _wait_until_it_answers(http)
        found.until("/stand", lambda stand: stand.get("state") == "ready" and stand.get("model") == "ready", 120.0)
        yield found
    process.terminate()
    process.wait(20.0)
    process.stdout.close()


def _wait_until_it_answers(http: httpx.Client) -> None:
    end = time.monotonic() + 20.0
    while True:
        try:
            http.get("/situations")
            return
        except httpx.TransportError:
            assert time.monotonic() < end, "the server does not answer"
            time.sleep(0.02)
