"""The file as it stands before the first sample: every group and dataset of `recording.md`, empty."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime

import h5py
import numpy as np

from stand.excitation.spec import Excitation
from stand.recorder.raw import StreamSpec, Wire
from stand.recorder.series import Series
from stand.recording.model import CHANNELS
from stand.recording.write import write_entry, write_excitation, write_setup
from stand.setup import Setup

GRID_RATE = 2000.0
TEXT = h5py.string_dtype("utf-8", 240)


@dataclass(frozen=True)
class FilePlan:
    """What is known before the run: streams, setup, excitation, and the stand's configuration as TOML.

    seconds: how long the run is expected to take; only the file's reserve hangs on it, nothing is cut off there.
    about: further lines for `/entry` (title, operator, comment, software).
    """

    streams: tuple[StreamSpec, ...]
    setup: Setup
    excitation: Excitation | None
    configuration: str = ""
    seconds: float = 30.0
    about: Mapping[str, str] = field(default_factory=dict)

    @property
    def reserve(self) -> float:
        """Seconds for which the file's chunks have room."""
        return 1.25 * self.seconds + 20.0


@dataclass(frozen=True)
class Layout:
    """The open file's growing parts. streams: instrument -> part -> series; data and events: name -> series."""

    streams: Mapping[str, Mapping[str, Series]]
    counters: Mapping[str, Mapping[str, h5py.Dataset]]
    data: Mapping[str, Series]
    events: Mapping[str, Series]

    def store(self) -> None:
        """Append everything collected so far."""
        for group in (*self.streams.values(), self.data, self.events):
            for series in group.values():
                series.store()


def create_layout(file: h5py.File, plan: FilePlan) -> Layout:
    """Write every object of the run's file; after this nothing is created until it is closed."""
    entry = write_entry(file)
    _about(entry, plan)
    data = _data(entry, plan)
    write_setup(entry, plan.setup)
    if plan.excitation is not None:
        write_excitation(entry, plan.excitation)
    instruments = entry.create_group("instruments")
    instruments.attrs["NX_class"] = "NXinstrument"
    groups = {spec.name: write_stream_about(instruments, spec) for spec in plan.streams}
    streams = {spec.name: _stream(groups[spec.name], spec, plan.reserve) for spec in plan.streams}
    counters = {name: write_counters(group, {}) for name, group in groups.items()}
    return Layout(streams, counters, data, _events(entry))


def mark_start(file: h5py.File) -> None:
    """Now is when the recording starts."""
    file["entry/start_time"][()] = _now()


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def _about(entry: h5py.Group, plan: FilePlan) -> None:
    entry.create_dataset("start_time", data=_now())
    for name, text in plan.about.items():
        entry.create_dataset(name, data=text)
    if plan.configuration:
        entry.create_dataset("configuration", data=plan.configuration).attrs["format"] = "TOML"


def _data(entry: h5py.Group, plan: FilePlan) -> dict[str, Series]:
    group = entry.create_group("data")
    channels = CHANNELS[plan.setup.system]
    names = [channel.name for channel in channels]
    group.attrs.update({"NX_class": "NXdata", "signal": "weight_position", "axes": "time", "provisional": True})
    group.attrs["auxiliary_signals"] = [name for name in names if name != "weight_position"]
    rows = int(plan.reserve * GRID_RATE)
    series = {"time": Series(group, "time", "f8", capacity=rows, units="s")}
    series |= {c.name: Series(group, c.name, "f8", capacity=rows, units=c.unit) for c in channels}
    return series | {"quality": Series(group, "quality", "u1", capacity=rows)}


def write_stream_about(instruments: h5py.Group, spec: StreamSpec) -> h5py.Group:
    """`instruments/<name>` with identity, calibration and sampling, without its series."""
    group = instruments.create_group(spec.name)
    group.attrs["NX_class"] = "NXsensor"
    group.create_dataset("sampling", data=spec.sampling)
    group.create_dataset("nominal_rate", data=spec.rate).attrs["units"] = "Hz"
    for part, texts in spec.texts.items():
        part_group = group.require_group(part)
        for name, text in texts.items():
            part_group.create_dataset(name, data=text)
    for part, numbers in spec.numbers.items():
        part_group = group.require_group(part)
        for name, (value, unit) in numbers.items():
            part_group.create_dataset(name, data=value).attrs["units"] = unit
    return group


def _stream(group: h5py.Group, spec: StreamSpec, seconds: float) -> dict[str, Series]:
    samples, reads = int(1.1 * spec.rate * seconds), int(spec.reads_per_second * seconds)
    series = {
        "values": Series(group, "values", "f8", capacity=samples, units=spec.unit),
        "flags": Series(group, "flags", "u1", capacity=samples),
    }
    if spec.wire is Wire.BYTES:
        return series | {
            "raw": Series(group, "raw", "u1", capacity=samples * spec.bytes_per_sample),
            "arrival_time": Series(group, "arrival_time", "f8", capacity=reads, units="s"),
            "arrival_bytes": Series(group, "arrival_bytes", "u4", capacity=reads),
        }
    return series | {
        "ticks": Series(group, "ticks", "i8", capacity=samples),
        "registers": Series(group, "registers", "u2", capacity=reads, width=spec.width),
        "request_time": Series(group, "request_time", "f8", capacity=reads, units="s"),
        "response_time": Series(group, "response_time", "f8", capacity=reads, units="s"),
    }


def write_counters(group: h5py.Group, counts: Mapping[str, int]) -> dict[str, h5py.Dataset]:
    """frames decoded, bytes of junk skipped, frames lost (known once the clock is fitted)."""
    names = ("frames_counted", "bytes_skipped", "frames_lost")
    return {name: group.create_dataset(name, data=np.int64(counts.get(name, 0))) for name in names}


def _events(entry: h5py.Group) -> dict[str, Series]:
    group = entry.create_group("events")
    group.attrs.update({"NX_class": "NXcollection", "complete": False})
    return {
        "host_time": Series(group, "host_time", "f8", capacity=4096, units="s"),
        "kind": Series(group, "kind", TEXT, capacity=4096),
        "text": Series(group, "text", TEXT, capacity=4096),
    }
