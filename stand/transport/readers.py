"""Readers: one thread an instrument that hands on what arrives, stamped, the moment it is there."""

from __future__ import annotations

import os
import random
import select
import time
from collections.abc import Callable

import numpy as np
import serial

from stand.block import Block
from stand.clock.aim import Aim
from stand.codecs.codec import Feeder, load_codec
from stand.config import GaugeConfig, Stand
from stand.drive.profile import load_profile
from stand.errors import DeviceError, StandError
from stand.transport import modbus
from stand.transport.link import Clock, ModbusLink
from stand.transport.priority import raise_priority
from stand.transport.raw import Raw, RawBytes, RawRegisters
from stand.transport.ring import RingDecoder
from stand.transport.worker import Worker

Sink = Callable[[Raw, Block | None], None]
OnError = Callable[[str, StandError], None]

#: a pause after each read lets a block gather; a fault reaches the sink this much later at most
GATHER = 0.0015
DITHER = 0.0012


class GaugeReader:
    """A streaming gauge on a serial port. Commands go out while its stream is read."""

    def __init__(self, instrument: str, config: GaugeConfig, clock: Clock = time.monotonic) -> None:
        self.instrument, self.config = instrument, config
        self.codec = load_codec(config.codec, f"{instrument}.codec")
        self.feeder = Feeder(self.codec, instrument)
        self._clock = clock
        self._port: serial.Serial | None = None
        self._worker = Worker(instrument)

    def open(self) -> None:
        """Open the port; DeviceError where there is none."""
        link = self.config.link
        try:
            self._port = serial.Serial(link.port, link.baud, timeout=0.2, exclusive=False)
        except (OSError, serial.SerialException) as error:
            remedy = "Check the cable and the port in the stand's file"
            raise DeviceError(
                f"can't open the port ({error})", where=f"{self.instrument}: {link.port}", remedy=remedy
            ) from error

    def close(self) -> None:
        """Stop reading and close the port; harmless twice."""
        self.stop()
        if self._port is not None:
            self._port.close()
            self._port = None

    def identify(self, timeout: float = 1.0) -> dict[str, str]:
        """What the device says of itself, and its codec; its stream goes on afterwards."""
        found = {"codec": self.codec.name, "model": self.codec.title}
        for name, (command, decode) in self.codec.identify.items():
            found[name] = decode(self.ask(command, timeout))
        return found

    def configure(self, timeout: float = 1.0) -> None:
        """The stand's sample rate, then streaming; nothing for a device that has no such commands."""
        for command in (self.codec.rate(self.config.rate), self.codec.start):
            if command:
                self.ask(command, timeout)

    def zero(self, timeout: float = 1.0) -> None:
        """The device's own tare, where it has one."""
        if self.codec.zero:
            self.ask(self.codec.zero, timeout)

    def ask(self, command: bytes, timeout: float = 1.0) -> bytes:
        """Send a command and wait for its answer; DeviceError where it refuses or is silent."""
        port, deadline = self._opened(), self._clock() + timeout
        seen = len(self.feeder.replies)
        port.write(command)
        while len(self.feeder.replies) == seen:
            if self._clock() > deadline:
                raise DeviceError(
                    "no answer", where=self.instrument, value=command.hex(), remedy="Check baud and cable"
                )
            if not self._worker.at_work:
                self.feeder.feed(self._read(port, 0.05), self._clock())
            else:
                time.sleep(0.002)
        reply = self.feeder.replies[-1]
        if complaint := self.codec.check_reply(reply):
            raise DeviceError(f"refused: {complaint}", where=self.instrument, value=command.hex())
        return reply

    def start(self, sink: Sink, on_error: OnError) -> None:
        """Read from now on, in a thread; what the host's buffer still holds is dropped first, and counting begins."""
        port = self._opened()
        port.reset_input_buffer()
        self.feeder = Feeder(self.codec, self.instrument)
        self._worker.start(self._run, port, sink, on_error)

    def stop(self) -> None:
        """End the thread; harmless twice."""
        self._worker.stop()

    def _opened(self) -> serial.Serial:
        if self._port is None:
            self.open()
        assert self._port is not None
        return self._port

    def _read(self, port: serial.Serial, timeout: float) -> bytes:
        descriptor = port.fileno()
        if not select.select([descriptor], [], [], timeout)[0]:
            return b""
        return os.read(descriptor, 65536)

    def _run(self, port: serial.Serial, sink: Sink, on_error: OnError) -> None:
        raise_priority()
        descriptor = port.fileno()
        try:
            while not self._worker.stopping.is_set():
                if not select.select([descriptor], [], [], 0.1)[0]:
                    continue
                data = os.read(descriptor, 65536)
                arrival = self._clock()  # after the read: a byte may be stamped late, never early
                if not data:
                    raise OSError("end of stream")
                block = self.feeder.feed(data, arrival)
                sink(RawBytes(self.instrument, data, arrival), block if len(block) else None)
                time.sleep(GATHER * random.random())
        except StandError as error:
            on_error(self.instrument, error)
        except (OSError, serial.SerialException, ValueError, TypeError) as error:
            if not self._worker.stopping.is_set():
                lost = DeviceError(f"link lost ({error})", where=self.instrument, remedy="Check the cable")
                on_error(self.instrument, lost)


class RingReader:
    """The drive's position ring on a connection of its own, polled where its samples meet, and dithered.

    Each poll brackets a sample's time from both sides, and it is the closest brackets that fix the clock; the dither
    keeps polls from beating with the ring.
    """

    def __init__(self, stand: Stand, clock: Clock = time.monotonic, seed: int | None = None) -> None:
        self.instrument = "drive"
        self.profile = load_profile(stand.drive.profile)
        if self.profile.trace.kind != "ring":
            remedy = "Poll it plainly, which is recorded as derived"
            raise DeviceError("the profile has no position ring", where=self.profile.profile.name, remedy=remedy)
        self.decoder = RingDecoder(self.profile, direction=stand.drive.direction)
        self._link, self._clock = ModbusLink(stand.drive.link, clock), clock
        self._period = 1.0 / stand.drive.poll_rate
        self._aim = Aim(self._period, 1.0 / self.profile.trace.clock_hz, DITHER, seed)
        self._worker = Worker("ring")
        trace = self.profile.trace
        self._request = modbus.read_registers(trace.head, self.decoder.count)

    def open(self) -> None:
        """Connect."""
        self._link.open()

    def close(self) -> None:
        """Stop polling and disconnect; harmless twice."""
        self.stop()
        self._link.close()

    def identify(self) -> dict[str, str]:
        """How the channel is sampled."""
        trace = self.profile.trace
        return {"profile": self.profile.profile.name, "trace": f"ring of {trace.depth} at {trace.clock_hz:g} Hz"}

    def set_word_order(self, order: str) -> None:
        """What the drive's start-up probe found."""
        self.decoder.swap = order == "little"

    def poll(self) -> RawRegisters:
        """One poll now."""
        answer, sent, received = self._link.stamped(self._request)
        registers: np.ndarray = modbus.register_array(answer)
        return RawRegisters(self.instrument, registers, sent, received)

    def start(self, sink: Sink, on_error: OnError) -> None:
        """Poll from now on, in a thread."""
        self.decoder.head = None
        self._worker.start(self._run, sink, on_error)

    def stop(self) -> None:
        """End the thread; harmless twice."""
        self._worker.stop()

    def _run(self, sink: Sink, on_error: OnError) -> None:
        raise_priority()
        due = self._clock()
        try:
            while not self._worker.stopping.is_set():
                raw = self.poll()
                sink(raw, self.decoder.decode(raw))
                self._aim.polled(self.decoder.head or 0, raw.request, raw.response)
                due = max(due + self._period, self._clock() - self._period)
                wait = self._aim.next(due) - self._clock()
                if wait > 0:
                    time.sleep(wait)
        except StandError as error:
            if not self._worker.stopping.is_set():
                on_error(self.instrument, error)
