"""The guardian: the end or the silence of its parent stops the drive; a parent that takes its leave doesn't."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from stand.errors import DeviceError
from stand.guardian import Guardian
from stand.guardian.client import StopOrder
from tests.stand.test_safety import TELEGRAM, OneDrive

PARENT = """
import sys, time
from pathlib import Path
from stand.guardian import Guardian
from stand.guardian.client import StopOrder
order = StopOrder("tcp", "127.0.0.1", int(sys.argv[1]), (bytes.fromhex(sys.argv[2]),))
guardian = Guardian(order, report=Path(sys.argv[3]))
guardian.start()
guardian.arm()
print(guardian.pid, flush=True)
time.sleep(60)
"""


def armed_parent(drive: OneDrive, report: Path) -> tuple[subprocess.Popen[bytes], int]:
    command = [sys.executable, "-c", PARENT, str(drive.port), TELEGRAM.hex(), str(report)]
    parent = subprocess.Popen(command, stdout=subprocess.PIPE, start_new_session=True)
    assert parent.stdout is not None
    return parent, int(parent.stdout.readline())


def gone(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    return False


def test_a_killed_acquisition_is_a_stopped_drive_within_a_quarter_of_a_second(tmp_path: Path) -> None:
    drive = OneDrive()
    parent, guardian = armed_parent(drive, tmp_path / "note.json")
    killed = time.monotonic()
    os.killpg(parent.pid, signal.SIGKILL)  # the whole group, as an impatient user would
    assert drive.came.wait(3.0)
    assert drive.received[0][0] - killed < 0.25
    assert drive.received[0][1] == TELEGRAM
    parent.wait()
    deadline = time.monotonic() + 3
    while not gone(guardian):
        assert time.monotonic() < deadline, "the guardian stays although its work is done"
        time.sleep(0.01)
    assert json.loads((tmp_path / "note.json").read_text())["guardian"] == "end"
    assert parent.stdout is not None
    parent.stdout.close()


def test_a_hanging_acquisition_is_stopped_and_kept_stopped(tmp_path: Path) -> None:
    drive = OneDrive()
    parent, _ = armed_parent(drive, tmp_path / "note.json")
    parent.send_signal(signal.SIGSTOP)
    halted = time.monotonic()
    assert drive.came.wait(3.0)
    assert drive.received[0][0] - halted < 0.35
    while len(drive.received) < 3:  # repeated as long as it hangs
        time.sleep(0.01)
    parent.kill()
    parent.wait()
    assert parent.stdout is not None
    parent.stdout.close()


def test_a_guardian_that_was_dismissed_stops_nothing() -> None:
    drive = OneDrive()
    guardian = Guardian(StopOrder("tcp", "127.0.0.1", drive.port, (TELEGRAM,)), limit=5.0)
    guardian.start()
    guardian.arm()
    assert guardian.check() is None
    guardian.close()
    assert gone(guardian.pid)
    assert drive.received == []


def test_the_acquisition_notices_that_its_guardian_is_gone() -> None:
    drive = OneDrive()
    guardian = Guardian(StopOrder("tcp", "127.0.0.1", drive.port, (TELEGRAM,)), limit=5.0)
    guardian.start()
    os.kill(guardian.pid, signal.SIGKILL)
    deadline = time.monotonic() + 3
    while guardian.check() is None:
        assert time.monotonic() < deadline
    assert guardian.check() == "the guardian process is gone"
    guardian.close()


def test_without_a_drive_there_is_no_guardian_and_no_run() -> None:
    with socket.socket() as nobody:  # bound, so that nobody else takes the port, but not listening
        nobody.bind(("127.0.0.1", 0))
        guardian = Guardian(StopOrder("tcp", "127.0.0.1", nobody.getsockname()[1], (TELEGRAM,)))
        with pytest.raises(DeviceError, match="guardian"):
            guardian.start()
    guardian.close()
