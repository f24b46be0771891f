"""One run from the first connection to the closed recording."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from pathlib import Path

from stand.config import Stand
from stand.drive.follow import follow
from stand.errors import DeviceError, InputError, StandError
from stand.excitation.plan import Plan, plan
from stand.recorder import FilePlan, Recorder
from stand.recorder.finish import finish_file
from stand.runs.checks import check_rest_force, check_state, go_to_rest, identify
from stand.runs.messages import Finished, Outcome, Phase, Progress
from stand.runs.order import RunOrder
from stand.runs.priority import ahead
from stand.runs.rehearsal import rehearse
from stand.runs.rig import Rig
from stand.runs.rules import guide_rule, preparing_rules, standing_rules
from stand.runs.streams import stream_specs
from stand.targets import make_folder

AFTER_TRIP = 0.3
LATE = 0.1
TELL = 0.25
GRID_RATE = 2000.0


@dataclass
class Span:
    """Host times of the grid's first sample and of its end, s (monotonic)."""

    origin: float = 0.0
    end: float = 0.0

    @property
    def count(self) -> int:
        """Whole samples between them."""
        return int((self.end - self.origin) * GRID_RATE + 1e-6)


def ordered_stand(stand: Stand, order: RunOrder) -> Stand:
    """The stand with the order's setup mounted."""
    return stand if order.setup is None else stand.with_setup(order.setup)


def run_path(stand: Stand, order: RunOrder) -> Path:
    """Where the recording goes; its folder is made, the file must not exist."""
    folder = make_folder(order.folder or stand.storage.folder)
    path = folder / order.file_name()
    if path.exists():
        raise InputError("exists already", where=str(path), remedy="Choose another name")
    return path


def perform(rig: Rig, order: RunOrder, path: Path) -> Finished:
    """Do the run on an unconnected rig; StandError where it can't be done, Finished however else it ends."""
    if order.excitation is None:
        raise InputError("no excitation", where="order", remedy="Name a shape, a frequency and a stroke")
    stand = rig.stand
    motion = plan(order.excitation, stand.limits, rest_travel=stand.drive.rest_travel)
    announce(rig, "connect")
    rehearse(stand)
    rig.connect()
    recorder = _recorder(path, _file_plan(stand, order, _check(rig), motion.duration))
    try:
        rig.arm()
        rig.read(preparing_rules(stand))
        _prepare(rig, order, motion.rest_travel)
    except BaseException:
        recorder.close()
        path.unlink()  # it holds nothing
        raise
    span, ending = Span(), Ending()
    try:
        _record(rig, recorder, motion, span, ending)
    finally:
        announce(rig, "stop")
        rig.come_to_rest()
        rig.end_reading()  # the last live samples go out before the long work begins
        announce(rig, "align")
        recorder.close()
    return close_run(rig, path, span, ending)


def _recorder(path: Path, about: FilePlan) -> Recorder:
    """A recorder that waits for its streams. HDF5 makes a file with the interpreter's lock held, and a busy disk can
    hold that up for most of a second: before anything is read or watched, nobody misses it.
    """
    recorder = Recorder(path, about)
    with ahead():
        recorder.start()
    return recorder


@dataclass
class Ending:
    """The error that broke off the recorded part, unless it followed from a trip."""

    error: StandError | None = None


def close_run(rig: Rig, path: Path, span: Span, ending: Ending) -> Finished:
    """Align and complete the file, and say how the run ended."""
    outcome, why = _outcome(rig, ending)
    fault = rig.trip.arrival if rig.trip is not None else None
    finish_file(path, rig.stand, origin=span.origin, count=span.count, outcome=outcome, why=why, fault=fault)
    announce(rig, "done")
    return Finished(path, outcome, why, rig.trip)


def _outcome(rig: Rig, ending: Ending) -> tuple[Outcome, str]:
    if rig.trip is not None:
        return Outcome.TRIPPED, str(rig.trip)
    if ending.error is not None:
        return Outcome.STOPPED, str(ending.error)
    return (Outcome.STOPPED, rig.halt.reason) if rig.halt.wanted() else (Outcome.FINISHED, "")


def announce(rig: Rig, name: str, text: str = "") -> None:
    """A phase of PHASES begins."""
    rig.publish(Phase(name, time.monotonic(), text))
    rig.acquisition.note("phase", f"{name}: {text}" if text else name)


def _check(rig: Rig) -> dict[str, dict[str, str]]:
    announce(rig, "check")
    check_state(rig)
    return identify(rig)


def _prepare(rig: Rig, order: RunOrder, rest_travel: float) -> None:
    if order.prepare:
        announce(rig, "prepare")
    go_to_rest(rig, rest_travel, move=order.prepare, home=order.home)
    for rule in standing_rules(rig.stand):
        rig.supervisor.add(rule)
    check_rest_force(rig)
    rig.supervisor.add(guide_rule(rig.stand, float(rig.acquisition.meters["dial_gauge"].recent().mean())))
    _still_allowed(rig)


def _still_allowed(rig: Rig) -> None:
    if rig.halt.wanted():
        raise DeviceError("the run was stopped before it began", value=rig.halt.reason)


def _file_plan(stand: Stand, order: RunOrder, identities: dict[str, dict[str, str]], seconds: float) -> FilePlan:
    about = {"title": order.name, "operator": order.operator, "comment": order.comment, "stand": stand.name}
    return FilePlan(
        stream_specs(stand, identities),
        stand.setup,
        order.excitation,
        stand.to_toml(),
        seconds,
        {name: text for name, text in about.items() if text},
    )


def _record(rig: Rig, recorder: Recorder, motion: Plan, span: Span, ending: Ending) -> None:
    rig.acquisition.record(recorder)
    rig.wait_for_samples()
    moment = Moment(rig, motion, span)
    try:
        with ahead():
            done = follow(rig.drive, motion, moment.should_stop, moment.begin)
        rig.acquisition.note("motion", f"{done.late} late steps, demand within {done.worst * 1e6:.0f} um of the plan")
    except StandError as error:
        rig.acquisition.note("error", str(error))
        ending.error = None if rig.halt.wanted() else error
    moment.end()


@dataclass
class Moment:
    """Where the run is: told by the motion's own loop, which asks at every step whether to stop."""

    rig: Rig
    motion: Plan
    span: Span
    _phases: list[tuple[float, str]] = field(default_factory=list)
    _told: float = 0.0

    def begin(self, started: float) -> None:
        """The motion's clock starts, at its first rest: the grid's sample 0."""
        self.span.origin = self.span.end = started
        self.rig.acquisition.note("origin", repr(started))
        self.rig.acquisition.align_from(started)
        rest, total = self.motion.rest, self.motion.duration
        self._phases = [(0.0, "rest"), (rest, "motion"), (total - rest, "settle")]

    def should_stop(self) -> bool:
        """True when the run is to end; asked right before every step."""
        elapsed = time.monotonic() - self.span.origin
        while self._phases and elapsed >= self._phases[0][0]:
            announce(self.rig, self._phases.pop(0)[1])
        if elapsed >= self._told + TELL:
            self._told = elapsed
            self.rig.publish(Progress(elapsed, self.motion.duration, 0, 0))
        if (trip := self.rig.guardian_trip()) is not None:
            self.rig.supervisor.raise_trip(trip)
        return self.rig.halt.wanted()

    def end(self) -> None:
        """The grid's end: the plan's, or now; then wait for what is still on its way."""
        now = time.monotonic()
        self.span.end = min(now, self.span.origin + self.motion.duration)
        if self.rig.trip is not None:
            time.sleep(AFTER_TRIP)  # what happened after the stop belongs to the record
            self.span.end = time.monotonic()
        time.sleep(LATE)
