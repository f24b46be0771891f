"""A recording played by simulated devices over the same transports: `python -m mocks replay RUN.h5 --speed max`."""

from __future__ import annotations

import argparse
import asyncio
import os
import shutil
import sys
import tempfile
import threading
import time
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from mocks.devices.axis import Axis
from mocks.devices.clock import DeviceClock
from mocks.devices.dictionary import Dictionary
from mocks.devices.nanotec import INPUTS, RING, RX, TX, NanotecDrive
from mocks.devices.playback import PlayClock, RecordedGauge, RecordedRing
from mocks.devices.ring import UNIT, Ring
from mocks.devices.server import DriveServers, LockedRegisters
from mocks.wire import gsv8, hlg1
from mocks.wire.relay import Relay
from mocks.wire.terminal import Terminal

GAUGES = ("force_gauge", "dial_gauge")
BAUDS = {"force_gauge": 230_400, "dial_gauge": 921_600}
BYTES = ("raw", "arrival_time", "arrival_bytes")
REGISTERS = ("registers", "request_time", "response_time")
MARGIN = 0.05  # s of the recording before its first byte


class ReplayError(ValueError):
    """A file that can't be replayed: what is missing and where."""


class PlayedDrive(NanotecDrive):
    """The drive of a recording: its ring plays, everything else answers, nothing moves."""

    recorded: RecordedRing

    def read_block(self, base: int) -> list[int] | None:
        """The recorded ring at 2000."""
        return self.recorded.registers(time.monotonic()) if base == RING else super().read_block(base)


class ReplayedStand:
    """Plays from the moment that both gauges' ports are open and the ring is read. speed 0: as fast as it is taken."""

    def __init__(self, path: Path, speed: float) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="fibre-replay-"))
        with _opened(path) as file:
            streams = {name: _stream(file, name, path) for name in ("drive", *GAUGES)}
            self.bauds = _bauds(file)
        origin = min(float(s["arrival_time" if "raw" in s else "request_time"][0]) for s in streams.values()) - MARGIN
        self.clock = PlayClock(speed, origin)
        self.drive = self._drive(streams["drive"], path)
        self.gauges = {name: self._gauge(name, streams[name]) for name in GAUGES}
        self.lock = threading.Lock()
        registers = LockedRegisters(self.drive, (RING, INPUTS, TX, RX), self.lock, self._look)
        self.relay = Relay(self.folder, "drive", 115_200)
        self.servers = DriveServers(registers, (RING, TX, RX), 0, self.relay.device, 115_200)
        self.loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self.loop.run_forever, name="modbus", daemon=True)

    def _drive(self, stream: dict[str, Any], path: Path) -> PlayedDrive:
        try:
            recorded = RecordedRing(stream["registers"], stream["request_time"], stream["response_time"], self.clock)
        except ValueError as error:
            raise ReplayError(f"{path}: /entry/instruments/drive: {error}") from None
        axis = Axis(float(recorded.values[-1]) * UNIT, time.monotonic())
        ring = Ring(DeviceClock(0.0, 0.0), (0.0, 0.0), np.random.default_rng(0), lambda *samples: None)
        drive = PlayedDrive(axis, ring, Dictionary(recorded.word_order), lambda kind, **facts: None)
        drive.recorded = recorded
        return drive

    def _gauge(self, name: str, stream: dict[str, Any]) -> RecordedGauge:
        answers = _force_answers() if name == "force_gauge" else _dial_answers()
        terminal = Terminal(self.folder, name)
        return RecordedGauge(
            terminal, stream["raw"], stream["arrival_time"], stream["arrival_bytes"], self.clock, answers
        )

    def _look(self, now: float) -> None:
        """At every access to the drive: does everybody listen by now?"""
        if self.drive.recorded.reads > 2 and all(gauge.held for gauge in self.gauges.values()):
            self.clock.begin(now)

    def start(self) -> dict[str, Any]:
        """All threads run; returns the announcement."""
        self._thread.start()
        self.relay.start()
        asyncio.run_coroutine_threadsafe(self.servers.start(), self.loop).result(10.0)
        for gauge in self.gauges.values():
            gauge.start()
        return {
            "ready": True,
            "pid": os.getpid(),
            "drive": {"tcp": f"127.0.0.1:{self.servers.port}", "rtu": str(self.relay.host.port), "unit_id": 1},
            **{name: {"port": str(g.terminal.port), "baud": self.bauds[name]} for name, g in self.gauges.items()},
            "ledger": None,
            "latency": {},
        }

    def stop(self) -> None:
        """End all threads, close everything."""
        for gauge in self.gauges.values():
            gauge.end()
        asyncio.run_coroutine_threadsafe(self.servers.stop(), self.loop).result(5.0)
        self.loop.call_soon_threadsafe(self.loop.stop)
        self._thread.join()
        self.relay.end()
        shutil.rmtree(self.folder, ignore_errors=True)


def _force_answers() -> Callable[[bytes], list[bytes]]:
    requests = gsv8.Requests()
    amplifier = gsv8.Amplifier(lambda: 0.0, lambda: None, lambda on: None, lambda rate: 2000.0)
    return lambda data: [amplifier.reply(*request) for request in requests.feed(data)]


def _dial_answers() -> Callable[[bytes], list[bytes]]:
    requests = hlg1.Requests()
    sensor = hlg1.Sensor(lambda: 0, lambda on: None, lambda rate: 2000.0)
    return lambda data: [reply for request in requests.feed(data) if (reply := sensor.reply(request))]


def _opened(path: Path) -> h5py.File:
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise ReplayError(f"{path}: can't be read as HDF5 ({error}). Name a recording") from None


def _stream(file: h5py.File, name: str, path: Path) -> dict[str, Any]:
    group = file.get(f"entry/instruments/{name}")
    parts = BYTES if name in GAUGES else REGISTERS
    if group is None or any(part not in group for part in parts):
        where = f"{path}: /entry/instruments/{name}"
        raise ReplayError(f"{where}: holds no {', '.join(parts)}. Only a run with its raw streams can be replayed")
    found = {part: group[part][()] for part in parts}
    if any(len(value) == 0 for value in found.values()):
        raise ReplayError(f"{path}: /entry/instruments/{name}: is empty. Nothing to replay")
    return found


def _bauds(file: h5py.File) -> dict[str, int]:
    """The lines' baud rates, from the stand's configuration where the recording has it."""
    text = file.get("entry/configuration")
    table = tomllib.loads(text[()].decode()) if text is not None else {}
    return {name: int(table.get(name, {}).get("link", {}).get("baud", BAUDS[name])) for name in GAUGES}


def main_replay(arguments: Sequence[str]) -> int:
    """The command line; 2 for a file that can't be replayed."""
    from mocks.__main__ import add_process_options, run

    parser = argparse.ArgumentParser(prog="python -m mocks replay", description=__doc__)
    parser.add_argument("recording", type=Path)
    parser.add_argument("--speed", type=_speed, default=1.0, help="times true speed, or max")
    add_process_options(parser)
    given = parser.parse_args(list(arguments))
    try:
        stand = ReplayedStand(given.recording, given.speed)
    except ReplayError as error:
        print(error, file=sys.stderr)
        return 2
    return run(stand, given.announce, given.parent, lambda: None)


def _speed(text: str) -> float:
    if text == "max":
        return 0.0
    speed = float(text)
    if not 0.01 <= speed <= 1000.0:
        raise argparse.ArgumentTypeError("0.01 to 1000, or max")
    return speed
