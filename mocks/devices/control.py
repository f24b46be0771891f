"""The control protocol: faults on demand, one line a command, answered "ok ..." or "error ..."."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mocks.devices.stand import SimulatedStand

HELP = """drop GAUGE FRAMES | corrupt GAUGE FRAMES | silence GAUGE SECONDS | overload force_gauge SECONDS |
alarm dial_gauge SECONDS | spike GAUGE VALUE SECONDS | disconnect GAUGE-or-drive SECONDS | fault drive [CODE] |
freeze drive SECONDS | added_mass KG | time | status"""
GAUGES = ("force_gauge", "dial_gauge")


class Control:
    """Carries out commands on a stand; ValueError for what is none."""

    def __init__(self, stand: SimulatedStand) -> None:
        self.stand = stand
        self._verbs: dict[str, Callable[[list[str]], str]] = {
            "drop": self._drop,
            "corrupt": self._corrupt,
            "silence": lambda a: self._until("silent", *self._timed(a)),
            "overload": lambda a: self._until("faulty", *self._timed(a)),
            "alarm": lambda a: self._until("faulty", *self._timed(a)),
            "spike": self._spike,
            "disconnect": self._disconnect,
            "fault": self._fault,
            "freeze": self._freeze,
            "added_mass": self._added_mass,
            "time": lambda a: repr(time.monotonic()),
            "status": lambda a: json.dumps(self.stand.status()),
        }

    def line(self, text: str) -> str:
        """The answer to a line, which is carried out."""
        verb, *arguments = text.split() or [""]
        if verb not in self._verbs:
            return f"error: no command {verb!r}; there are {' '.join(HELP.split())}"
        try:
            with self.stand.lock:
                self.stand.world.advance(time.monotonic())
                told = self._verbs[verb](arguments)
                if verb not in ("time", "status"):
                    self.stand.event("control", command=text.strip())
        except (ValueError, IndexError, TypeError, KeyError) as error:
            return f"error: {text.strip()!r}: {error}; there are {' '.join(HELP.split())}"
        return f"ok {told}".strip()

    def _timed(self, arguments: list[str]) -> tuple[str, float]:
        name, seconds = arguments
        if name not in GAUGES:
            raise ValueError(f"no gauge {name!r}")
        return name, self._later(seconds)

    def _later(self, seconds: str) -> float:
        if not 0.0 <= float(seconds) <= 3600.0:
            raise ValueError("0 to 3600 seconds")
        return time.monotonic() + float(seconds)

    def _until(self, trouble: str, name: str, until: float) -> str:
        setattr(self.stand.gauges[name].trouble, trouble, until)
        return ""

    def _drop(self, arguments: list[str]) -> str:
        name, frames = arguments
        self.stand.gauges[name].trouble.drop += int(frames)
        return ""

    def _corrupt(self, arguments: list[str]) -> str:
        name, frames = arguments
        self.stand.gauges[name].trouble.corrupt += int(frames)
        return ""

    def _spike(self, arguments: list[str]) -> str:
        name, value, seconds = arguments
        self.stand.gauges[name].trouble.spike_value = float(value)
        return self._until("spike", name, self._later(seconds))

    def _disconnect(self, arguments: list[str]) -> str:
        name, seconds = arguments[0], arguments[1] if len(arguments) > 1 else "1"
        if name == "drive":
            self.stand.disconnect_drive(float(seconds))
            return ""
        return self._until("broken", *self._timed([name, seconds]))

    def _fault(self, arguments: list[str]) -> str:
        self.stand.drive.fault(int(arguments[1], 0) if len(arguments) > 1 else 0x2310)
        return ""

    def _freeze(self, arguments: list[str]) -> str:
        self.stand.axis.frozen_until = self._later(arguments[1])
        return ""

    def _added_mass(self, arguments: list[str]) -> str:
        mass = float(arguments[0])
        if not 0.0 <= mass <= 50.0:
            raise ValueError("0 to 50 kg")
        self.stand.world.load(mass)
        return ""


async def serve_control(control: Control) -> asyncio.Server:
    """The protocol at a port that the system gives, on loopback."""

    async def talk(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        while line := await reader.readline():
            writer.write(control.line(line.decode("ascii", "replace")).encode() + b"\n")
            await writer.drain()
        writer.close()

    return await asyncio.start_server(talk, "127.0.0.1", 0)
