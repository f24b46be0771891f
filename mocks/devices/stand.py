"""The simulated stand, whole: plant, drive, gauges, servers, control, ledger."""

from __future__ import annotations

import asyncio
import os
import shutil
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np

from mocks.config import DriveConfig, GaugeConfig, StandConfig
from mocks.devices.axis import Axis
from mocks.devices.clock import DeviceClock
from mocks.devices.control import Control, serve_control
from mocks.devices.dictionary import Dictionary
from mocks.devices.gauge import Gauge, Head, Sensing
from mocks.devices.heads import DialHead, ForceHead
from mocks.devices.latency import drive_latency, port_latency
from mocks.devices.nanotec import INPUTS, RING, RX, TX, NanotecDrive
from mocks.devices.rehearsal import rehearse
from mocks.devices.ring import Ring
from mocks.devices.scheduler import Scheduler
from mocks.devices.server import DriveServers, LockedRegisters
from mocks.devices.world import FORCE, WEIGHT, World
from mocks.ledger import Ledger, Rows
from mocks.plant.operator import draw_stand
from mocks.plant.plant import Plant
from mocks.plant.rig import Rig
from mocks.wire.line import Adapter, Line
from mocks.wire.relay import Relay
from mocks.wire.terminal import Terminal

PPM, DRIFT = 1e-6, 50.0
FLUSH = 0.25  # s
DIAL_ZERO = 0.1  # m within which the dial gauge's own zero is drawn


def rig_of(config: StandConfig) -> Rig:
    """The true rig: the published one, its values drawn by config.errors, then as config.plant says."""
    drawn = draw_stand(config.seed, errors=config.errors)
    true = drawn.hiding(config.hidden) if config.errors else Rig()
    return true.but(**dict(config.plant))


class SimulatedStand:
    """Runs from `start` to `stop`. ledger: folder for the truth, or None."""

    def __init__(self, config: StandConfig, ledger: Path | None = None) -> None:
        self.config = config
        self.rng = np.random.default_rng(config.seed)
        self.folder = Path(tempfile.mkdtemp(prefix="fibre-stand-"))
        plant = Plant(rig_of(config), config.hidden)
        Plant(rig_of(config)).advance(20, 0.0, 0.0)
        self.clocks = plant.world.clocks
        self.world = World(plant, time.monotonic())
        self.ledger = Ledger(ledger, {}) if ledger else None
        self.axis = Axis(config.drive.rest_travel, self.world.start)
        self.drive = self._drive(config.drive)
        self.world.mover = self.drive
        self.gauges = {
            "force_gauge": self._gauge("force_gauge", config.force_gauge, ForceHead(), FORCE),
            "dial_gauge": self._gauge("dial_gauge", config.dial_gauge, DialHead(), WEIGHT),
        }
        rehearse(self.world, self.gauges.values())
        if self.ledger:
            self.ledger.describe(self.facts())
        self.scheduler = Scheduler(self.world, list(self.gauges.values()))
        self.lock = self.scheduler.lock
        bases = (RING, INPUTS, TX, RX)
        self.registers = LockedRegisters(self.drive, bases, self.lock, self.world.advance)
        self.relay = Relay(self.folder, "drive", config.drive.rtu_baud)
        live, drive = (RING, TX, RX), config.drive
        self.servers = DriveServers(self.registers, live, drive.tcp_port, self.relay.device, drive.rtu_baud)
        self.control = Control(self)
        self.control_port = 0
        self.loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self.loop.run_forever, name="modbus", daemon=True)
        self._clerk = threading.Thread(target=self._keep_books, name="ledger", daemon=True)
        self._closing = threading.Event()
        self._faults = sorted(config.faults, key=lambda fault: fault.at)

    def _clock(self, name: str, config: DriveConfig | GaugeConfig, period: float) -> DeviceClock:
        """Phase within a sample's period and drift, as configured or drawn; both are drawn in any case."""
        drift, phase = self.rng.uniform(-DRIFT, DRIFT), self.rng.uniform(0.0, 1.0)
        drift = drift if config.drift_ppm is None else config.drift_ppm
        phase = phase if config.phase is None else config.phase
        rate = (1.0 + drift * PPM) * (1.0 + self.clocks.get(name, 0.0)) - 1.0
        return DeviceClock(self.world.start + phase * period, rate)

    def _drive(self, config: DriveConfig) -> NanotecDrive:
        clock = self._clock("drive", config, 1e-3)
        encoder = (config.encoder_resolution, config.encoder_noise)
        ring = Ring(clock, encoder, np.random.default_rng(self.rng.integers(1 << 62)), self._ring_samples)
        return NanotecDrive(self.axis, ring, Dictionary(config.word_order, config.byte_order), self.event)

    def _ring_samples(self, counter: Any, due: Any, value: Any, true: Any) -> None:
        if self.ledger:
            self.ledger.rows("drive", Rows.of(counter, counter / 1000.0, due, value, true))

    def _gauge(self, name: str, config: GaugeConfig, head: Head, channels: slice) -> Gauge:
        rng = np.random.default_rng(self.rng.integers(1 << 62))
        clock = self._clock(name, config, 1.0 / config.rate)
        zero = rng.uniform(-DIAL_ZERO, DIAL_ZERO) if name == "dial_gauge" else 0.0
        zero = zero if config.zero is None else config.zero
        timer = config.bunching * (1.0 + rng.uniform(-1.0, 1.0) * config.bunching_error)
        phase = self.world.start + rng.uniform(0.0, 1.0) * timer
        return Gauge(
            name=name, head=head, terminal=Terminal(self.folder, name), clock=clock, rng=rng,
            sensing=Sensing(config.noise, config.quantisation, zero, config.conversion, config.limit),
            line=Line(10.0 / config.baud), adapter=Adapter(rng, timer, config.jitter, phase),
            signal=lambda times: self.world.pair(channels, times),
            log=lambda rows: self._log(name, rows), rate=config.rate, batch=config.batch,
        )  # fmt: skip

    def _log(self, name: str, rows: Rows) -> None:
        if self.ledger:
            self.ledger.rows(name, rows)

    def event(self, kind: str, **facts: Any) -> None:
        """For the ledger: something happened now."""
        if self.ledger:
            self.ledger.event(time.monotonic(), kind, **facts)

    def facts(self) -> dict[str, Any]:
        """What the ledger's header states: clocks, zeros, the seed, what is hidden."""
        devices = {
            name: {"drift": g.clock.drift, "epoch": g.clock.epoch, "zero": g.sensing.zero, "unit": unit, "rate": g.rate}
            for (name, g), unit in zip(self.gauges.items(), ("N", "m"), strict=True)
        }
        clock = self.drive.ring.clock
        devices["drive"] = {
            "drift": clock.drift, "epoch": clock.epoch, "zero": self.axis.rest, "unit": "m", "rate": 1000.0
        }  # fmt: skip
        return {"devices": devices, "seed": self.config.seed, "hidden": self.config.hidden, "start": self.world.start}

    def status(self) -> dict[str, Any]:
        """For the control protocol."""
        return {
            "state": self.drive.state.name, "error": self.drive.error, "travel": self.axis.actual,
            "velocity": self.axis.velocity, "counters": {n: g.counter for n, g in self.gauges.items()},
            "ring": self.drive.ring.count, "force": self.gauges["force_gauge"].newest,
        }  # fmt: skip

    def _keep_books(self) -> None:
        """Ledger to the disk, which may take its time, and the configured faults when they are due."""
        while not self._closing.wait(FLUSH):
            if self.ledger:
                self.ledger.flush()
            while self._faults and time.monotonic() - self.world.start >= self._faults[0].at:
                command = self._faults.pop(0).command
                self.loop.call_soon_threadsafe(self.control.line, command)

    def disconnect_drive(self, seconds: float) -> None:
        """The drive's TCP side is gone for a while."""
        asyncio.run_coroutine_threadsafe(self.servers.break_off(seconds), self.loop)

    def start(self) -> dict[str, Any]:
        """All threads run; returns the announcement."""
        self._thread.start()
        self.relay.start()
        asyncio.run_coroutine_threadsafe(self._open(), self.loop).result(10.0)
        self.scheduler.start()
        self._clerk.start()
        return self.announcement()

    async def _open(self) -> None:
        await self.servers.start()
        control = await serve_control(self.control)
        self.control_port = control.sockets[0].getsockname()[1]

    def announcement(self) -> dict[str, Any]:
        """What the process says when it is ready."""
        host = "127.0.0.1"
        looks: list[float] = []
        self.registers.looks = looks
        legs = drive_latency(host, self.servers.port, self.config.drive.unit_id, looks)
        self.registers.looks = None
        latency = {"drive": legs.fixed, "drive_request": legs.request, "drive_answer": legs.answer}
        latency["port"] = port_latency(Terminal(self.folder, "trial"))
        latency |= {name: gauge.latency + latency["port"] for name, gauge in self.gauges.items()}
        return {
            "ready": True, "pid": os.getpid(),
            "drive": {
                "tcp": f"{host}:{self.servers.port}", "rtu": str(self.relay.host.port),
                "unit_id": self.config.drive.unit_id, "rtu_baud": self.config.drive.rtu_baud,
            },
            **{n: {"port": str(g.terminal.port), "baud": getattr(self.config, n).baud} for n, g in self.gauges.items()},
            "control": f"{host}:{self.control_port}",
            "ledger": str(self.ledger.folder) if self.ledger else None, "latency": latency,
        }  # fmt: skip

    def stop(self) -> None:
        """End all threads, close everything."""
        self.scheduler.end()
        self._closing.set()
        self._clerk.join()
        asyncio.run_coroutine_threadsafe(self.servers.stop(), self.loop).result(5.0)
        self.loop.call_soon_threadsafe(self.loop.stop)
        self._thread.join()
        self.relay.end()
        for gauge in self.gauges.values():
            gauge.terminal.disconnect()
        shutil.rmtree(self.folder, ignore_errors=True)
        if self.ledger:
            self.ledger.close()
