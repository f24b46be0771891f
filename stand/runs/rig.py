"""Everything that holds a device while the acquisition lives: opened together, closed together."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from types import TracebackType

from stand.clock.model import LiveBlock
from stand.config import Stand
from stand.drive.drive import Drive
from stand.errors import DeviceError, StandError
from stand.guardian import Guardian
from stand.runs.acquisition import Acquisition, Reader, make_readers
from stand.runs.checks import await_standstill
from stand.runs.halt import Halt
from stand.runs.messages import Health
from stand.runs.priority import ahead
from stand.runs.rules import stale_rule
from stand.runs.stopping import stop_order
from stand.safety import QuickStop, Rule, Supervisor, Trip
from stand.transport.readers import GaugeReader, RingReader

Publish = Callable[[object], None]
CONFIRMED = 0.5


class Rig:
    """The stand's devices with safety around them; a context manager. `moves`: False for a replay.

    report: where the guardian says why it stopped the drive, should it come to that.
    """

    def __init__(self, stand: Stand, publish: Publish, *, moves: bool = True, report: Path | None = None) -> None:
        self.stand, self.publish, self.moves = stand, publish, moves
        self.halt, self.drive = Halt(), Drive(stand.drive, stand.limits)
        self.readers: dict[str, Reader] = make_readers(stand)
        self.identities: dict[str, dict[str, str]] = {}
        order = stop_order(stand)
        self.quick_stop, self.guardian = QuickStop(order), Guardian(order, report=report)
        watch = [self.guardian_trip] if moves else []
        self.supervisor = Supervisor([], self._trip, stale=stale_rule(stand), others=watch)
        self.acquisition = Acquisition(stand, self.readers, self.supervisor, self._publish, self._lost)
        self._reading, self._armed = False, False

    def __enter__(self) -> Rig:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, tb: TracebackType | None) -> None:
        self.close()

    def connect(self) -> None:
        """Open every link; DeviceError naming the one that fails."""
        if self.moves:
            self.drive.connect()
            with ahead():
                self._connect_quick_stop()
                self.guardian.start()
        for reader in self.readers.values():
            reader.open()
        if self.moves:
            self._configure()

    def connect_what_answers(self) -> dict[str, str]:
        """Open what can be opened, for a look at the stand; device -> why it can't be reached, of the others."""
        problems = {}
        for name, reader in list(self.readers.items()):
            try:
                if name == "drive":
                    self.drive.connect()
                reader.open()
                self.identities[name] = reader.identify()
            except StandError as error:
                problems[name] = str(error)
                del self.readers[name]
        return problems

    def _configure(self) -> None:
        """Tell the gauges their rate and to stream, and the ring's reader what the drive's probe has found."""
        for reader in self.readers.values():
            if isinstance(reader, GaugeReader):
                reader.configure()
            elif isinstance(reader, RingReader):
                reader.set_word_order(self.drive.word_order)

    def read(self, rules: Iterable[Rule]) -> None:
        """Start the streams under these rules, and wait until each of them delivers."""
        for rule in rules:
            self.supervisor.add(rule)
        self.read_unwatched()
        with ahead():
            self.supervisor.start()

    def read_unwatched(self) -> None:
        """The same without a watchdog, for a replay, which may end at any time."""
        self._reading = True
        with ahead():
            self.acquisition.start()
        self.wait_for_samples()

    def wait_for_samples(self, timeout: float = 3.0) -> None:
        """Until every instrument has sent something from now on; DeviceError naming the one that doesn't."""
        meters = {name: self.acquisition.meters[name] for name in self.readers}
        before, end = {name: meter.samples for name, meter in meters.items()}, time.monotonic() + timeout
        while silent := [name for name, meter in meters.items() if meter.samples == before[name]]:
            if time.monotonic() > end:
                remedy = "Check its power, its link and its output mode"
                raise DeviceError("sends nothing", where=silent[0], remedy=remedy)
            self.halt.wait(0.005)

    def arm(self) -> None:
        """From here on the guardian stops the drive when this process dies."""
        if self.moves:
            self.guardian.arm()
            self._armed = True

    def disarm(self) -> None:
        """The drive rests."""
        self._armed = False
        if self.moves:
            self.guardian.disarm()

    @property
    def trip(self) -> Trip | None:
        """What the safety has found, if anything."""
        return self.supervisor.trip

    def come_to_rest(self) -> None:
        """The safe state: the drive at rest and moving no more by itself; only then may the guardian rest, too."""
        if not self._armed:
            return
        try:
            if self.trip is None:
                self.drive.stop()
            await_standstill(self.drive)
        except StandError as error:
            self.acquisition.note("error", f"the drive did not confirm its stop: {error}")
            self.quick_stop.trigger()
            self.quick_stop.confirmed.wait(CONFIRMED)
        self.disarm()

    def end_reading(self) -> None:
        """End the watchdog, then the streams: their silence is no longer a fault."""
        self.supervisor.close()
        if self._reading:
            self._reading = False
            self.acquisition.stop()

    def close(self) -> None:
        """Bring the drive to rest and let go of everything; each part even if another one fails."""
        closers: list[Callable[[], None]] = [self.come_to_rest, self.end_reading]
        closers += [self.quick_stop.close, self.guardian.close]
        closers += [reader.close for reader in self.readers.values()]
        if self.moves:
            closers.append(self.drive.close)
        for closer in closers:
            with contextlib.suppress(Exception):
                closer()

    def _connect_quick_stop(self) -> None:
        try:
            self.quick_stop.start()
        except OSError as error:
            remedy = "Check that the drive accepts further Modbus connections"
            raise DeviceError(f"no second connection ({error})", where="quick stop", remedy=remedy) from error

    def _trip(self, trip: Trip) -> None:
        if self.moves:
            self.quick_stop.trigger()
        self.halt.want(str(trip))
        self.acquisition.note("trip", str(trip))
        self.publish(trip)

    def _lost(self, instrument: str, what: str) -> None:
        if self.moves:
            self.supervisor.raise_trip(Trip("lost link", f"{instrument}: {what}", instrument, arrival=time.monotonic()))

    def _publish(self, message: LiveBlock | Health) -> None:
        self.publish(message)

    def guardian_trip(self) -> Trip | None:
        """A trip where the drive may move and its guardian is silent."""
        why = self.guardian.check() if self._armed else None
        return Trip("guardian", why, arrival=time.monotonic()) if why else None
