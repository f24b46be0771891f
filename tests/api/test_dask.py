"""A diagnosis spread over a Dask cluster of real processes says the same as one in this process."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from api.cli import run
from mocks.plant.motion import Motion
from mocks.plant.operator import draw_stand
from mocks.record import record

pytest.importorskip("distributed")
HIDDEN = {"fibre-viscoelasticity": {"stiffness": 8e3, "time_constant": 0.02}}  # it and its rivals have a memory


def start(*arguments: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "dask", *arguments, "--no-dashboard"]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a scheduler with one worker."""
    file = tmp_path_factory.mktemp("dask") / "scheduler.json"
    processes = [start("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file))]
    try:
        while not file.exists() or not file.read_text():
            assert processes[0].poll() is None
            time.sleep(0.05)
        address = str(json.loads(file.read_text())["address"])
        processes.append(start("worker", address, "--nthreads", "2", "--no-nanny"))
        yield address
    finally:
        for process in reversed(processes):
            process.terminate()
            process.wait(10.0)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs")
    motion = Motion("trapezoidal", 1.5, 0.05, 0.2)
    return record(draw_stand(61), motion, path=folder / "run.h5", seconds=4.0, seed=61, hidden=HIDDEN)


def verdict(recording: Path, *options: str) -> dict[str, Any]:
    """What `stand diagnose` writes."""
    told = recording.with_name("verdict.json")
    assert run(["diagnose", str(recording), "--json", str(told), *options]) == 0
    content: dict[str, Any] = json.loads(told.read_text())
    return content


def wait_for_worker(address: str) -> None:
    from distributed import Client

    with Client(address, set_as_default=False) as client:
        client.wait_for_workers(1, timeout=30)


@pytest.mark.slow
def test_the_verdict_is_the_same(cluster: str, recording: Path) -> None:
    wait_for_worker(cluster)
    spread = verdict(recording, "--dask", cluster)
    assert "fibre-viscoelasticity" in [c["name"] for c in spread["causes"]]
    assert spread == verdict(recording)


def test_an_address_where_nobody_answers_is_refused(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["diagnose", str(recording), "--dask", "tcp://127.0.0.1:9"]) == 2
    said = capsys.readouterr().err
    assert "no Dask scheduler answers" in said
    assert "dask worker" in said
