"""Closing a recording: the final alignment is computed from the raw streams, everything is packed into a new file."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from stand.clock import Aligned, align
from stand.config import Stand
from stand.recorder.arrivals import Stream, read_streams
from stand.recorder.layout import TEXT
from stand.recording.model import CHANNELS, Quality

CLOCK_UNITS = {
    "offset": "s",
    "period": "s",
    "drift": "1",
    "residual": "s",
    "fit_sigma": "s",
    "sigma": "s",
    "latency": "s",
}
RECOVERED = "recovered"
PACK: Mapping[str, Any] = {"compression": "gzip", "compression_opts": 4, "shuffle": True}


def finish_file(
    path: Path,
    stand: Stand,
    *,
    origin: float,
    count: int,
    outcome: str,
    why: str = "",
    complete: bool = True,
    streams: Mapping[str, Stream] | None = None,
    fault: float | None = None,
) -> Aligned:
    """Replace the file at `path` by its final form; until the last moment the old one stays readable.

    origin: host time of grid sample 0, s; count: samples. streams: other arrivals than the file's own (a replay's
    injected ones), which are then what the file keeps. complete: False for what was recovered. fault: host time from
    which on a fault was active.
    """
    packed = path.with_name(f".{path.name}.closing")
    packed.unlink(missing_ok=True)
    with h5py.File(path, "r") as old, h5py.File(packed, "w") as new:
        used = streams if streams is not None else read_streams(old)
        order = _word_order(old)
        aligned = _marked(align(used, stand, origin=origin, count=count, word_order=order), fault)
        _pack(old, new, aligned, stand, streams or {})
        _end(new, aligned, outcome, why, complete)
        new.flush()
    _settle(packed, path)
    return aligned


def _word_order(file: h5py.File) -> str | None:
    """What the drive's probe had found, where there was one."""
    found = file.get("entry/instruments/drive/identity/word_order")
    return None if found is None else str(found[()].decode())


def _marked(aligned: Aligned, fault: float | None) -> Aligned:
    if fault is None:
        return aligned
    quality = aligned.quality.copy()
    quality[aligned.time >= fault - aligned.origin] |= np.uint8(Quality.FAULT)
    return dataclasses.replace(aligned, quality=quality)


def _settle(packed: Path, path: Path) -> None:
    with packed.open("rb") as file:
        os.fsync(file.fileno())
    packed.replace(path)


def _pack(old: h5py.File, new: h5py.File, aligned: Aligned, stand: Stand, streams: Mapping[str, Stream]) -> None:
    new.attrs.update(dict(old.attrs))
    entry = new.create_group("entry")
    entry.attrs.update(dict(old["entry"].attrs))
    for name, item in old["entry"].items():
        if name not in ("data", "instruments", "events"):
            old.copy(item, entry, name)
    _write_data(entry, aligned, stand)
    instruments = entry.create_group("instruments")
    instruments.attrs.update(dict(old["entry/instruments"].attrs))
    for name, group in old["entry/instruments"].items():
        copied = pack_group(group, instruments, name, replaced=_arrays(streams.get(name)))
        _write_clock(copied, aligned, name)
    pack_group(old["entry/events"], entry, "events")


def _arrays(stream: Stream | None) -> Mapping[str, Any]:
    names = ("raw", "arrival_time", "arrival_bytes", "registers", "request_time", "response_time")
    return {} if stream is None else {name: getattr(stream, name) for name in names if hasattr(stream, name)}


def pack_group(
    source: h5py.Group, parent: h5py.Group, name: str, replaced: Mapping[str, Any] | None = None
) -> h5py.Group:
    """A copy of a group whose series are compressed and in chunks of their own size."""
    group = parent.create_group(name)
    group.attrs.update(dict(source.attrs))
    for key, item in source.items():
        if not isinstance(item, h5py.Dataset) or item.shape == () or not len(item):
            source.copy(item, group, key)
            continue
        values = (replaced or {}).get(key)
        dataset = group.create_dataset(key, data=item[()] if values is None else values, dtype=item.dtype, **PACK)
        dataset.attrs.update(dict(item.attrs))
    return group


def _write_data(entry: h5py.Group, aligned: Aligned, stand: Stand) -> None:
    data = entry.create_group("data")
    names = [channel.name for channel in CHANNELS[stand.setup.system]]
    data.attrs.update({"NX_class": "NXdata", "signal": "weight_position", "axes": "time"})
    data.attrs.update({"provisional": False, "host_origin": aligned.origin})
    data.attrs["derived"] = ", ".join(sorted(aligned.derived)) or "none"
    data.attrs["auxiliary_signals"] = [name for name in names if name != "weight_position"]
    data.create_dataset("time", data=aligned.time, **PACK).attrs["units"] = "s"
    for channel in CHANNELS[stand.setup.system]:
        dataset = data.create_dataset(channel.name, data=aligned.channels[channel.name], **PACK)
        dataset.attrs["units"] = channel.unit
        if channel.name in aligned.zeros:
            dataset.attrs["zero"] = aligned.zeros[channel.name]
        if channel.name in aligned.uncertainty:
            dataset.attrs["uncertainty"] = aligned.uncertainty[channel.name]
    data.create_dataset("quality", data=np.asarray(aligned.quality, np.uint8), **PACK)


def _write_clock(group: h5py.Group, aligned: Aligned, name: str) -> None:
    counts = aligned.counts.get(name, {})
    group["frames_lost"][()] = counts.get("lost", 0)
    group["bytes_skipped"][()] = counts.get("junk", 0)
    clock = aligned.clocks.get(name)
    if clock is None:
        return
    fitted = group.create_group("clock")
    for part, value in dataclasses.asdict(clock).items():
        dataset = fitted.create_dataset(part, data=value)
        if part in CLOCK_UNITS:
            dataset.attrs["units"] = CLOCK_UNITS[part]


def _end(new: h5py.File, aligned: Aligned, outcome: str, why: str, complete: bool) -> None:
    entry, events = new["entry"], new["entry/events"]
    entry.create_dataset("end_time", data=datetime.now(UTC).isoformat(timespec="milliseconds"))
    _add_gaps(events, [(gap.time, f"{gap.instrument}: {gap.count} frames lost") for gap in aligned.losses])
    times = events["host_time"][()] - aligned.origin
    events.create_dataset("time", data=times).attrs["units"] = "s"
    events.attrs.update({"outcome": str(outcome), "why": why, "complete": complete})
    events.attrs["recovered"] = outcome == RECOVERED


def _add_gaps(events: h5py.Group, gaps: list[tuple[float, str]]) -> None:
    """Merge the gaps into the events, in the order of time."""
    if not gaps:
        return
    times = [*events["host_time"][()], *(time for time, _ in gaps)]
    order = np.argsort(times, kind="stable")
    columns = {
        "host_time": times,
        "kind": [*events["kind"][()], *(b"gap" for _ in gaps)],
        "text": [*events["text"][()], *(text.encode()[:240] for _, text in gaps)],
    }
    for name, values in columns.items():
        attributes = dict(events[name].attrs)
        del events[name]
        kept = np.empty(len(times), "f8" if name == "host_time" else TEXT)
        kept[:] = [values[i] for i in order]
        events.create_dataset(name, data=kept, dtype=kept.dtype).attrs.update(attributes)
