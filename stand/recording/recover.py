"""Redo a recording that a killed process left behind: align its raw streams, pack it, say what happened."""

from __future__ import annotations

import contextlib
import json
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from stand.clock.model import RingStream
from stand.config import Stand, load_stand_text
from stand.errors import InputError
from stand.recorder.arrivals import Stream, read_streams
from stand.recorder.finish import RECOVERED, finish_file
from stand.recorder.layout import GRID_RATE

SHORTEST = 0.5


@dataclass(frozen=True, slots=True)
class Recovered:
    """path; seconds of grid before (provisional) and after; what the guardian did, in words, if it left a note."""

    path: Path
    seconds_before: float
    seconds: float
    guardian: str


def recover(path: Path | str) -> Recovered:
    """Redo the file in place and return what was gained; InputError where there is nothing to recover.

    A file that was recovered before stays as it is: the same streams give the same grid.
    """
    path = Path(path)
    with _open(path) as file:
        _refuse_complete(file, path)
        if (before := _recovered_before(file)) is not None:
            return Recovered(path, before, before, "It was recovered before: nothing was changed")
        stand = _stand(file, path)
        before = len(file["entry/data/time"]) / GRID_RATE
        streams = read_streams(file)
        origin, end = _span(file, streams, path)
    note = _guardian_note(path)
    why = "recovered after the acquisition ended without closing the file" + (f"; {note}" if note else "")
    count = int((end - origin) * GRID_RATE)
    aligned = finish_file(path, stand, origin=origin, count=count, outcome=RECOVERED, why=why, complete=False)
    with contextlib.suppress(FileNotFoundError):
        path.with_name(f".{path.name}.closing").unlink()
    return Recovered(path, before, len(aligned.time) / GRID_RATE, note)


def _open(path: Path) -> h5py.File:
    if not path.is_file():
        raise InputError("no such file", where=str(path), remedy="Check the path")
    try:
        return h5py.File(path, "r")
    except OSError as error:
        what = f"not a readable HDF5 file ({error})"
        remedy = "A run still being recorded is locked: wait or stop it; a file that was cut short can't be redone"
        raise InputError(what, where=str(path), remedy=remedy) from error


def _refuse_complete(file: h5py.File, path: Path) -> None:
    if "entry/instruments" not in file or "entry/events" not in file:
        raise InputError("holds no raw streams", where=str(path), remedy="Only this stand's own runs can be recovered")
    if file["entry/events"].attrs.get("complete", False):
        raise InputError("is complete", where=str(path), remedy="There is nothing to recover")


def _recovered_before(file: h5py.File) -> float | None:
    """Seconds of the final grid, s, where the file already has one."""
    data = file["entry/data"]
    return None if data.attrs.get("provisional", True) else len(data["time"]) / GRID_RATE


def _stand(file: h5py.File, path: Path) -> Stand:
    text = file.get("entry/configuration")
    if text is None:
        raise InputError("missing", where=f"{path}:/entry/configuration", remedy="The stand's configuration is needed")
    return load_stand_text(text[()].decode(), f"{path}:/entry/configuration")


def _span(file: h5py.File, streams: dict[str, Stream], path: Path) -> tuple[float, float]:
    """Host times of the grid's beginning and end: all instruments must cover it."""
    arrivals = [s.response_time if isinstance(s, RingStream) else s.arrival_time for s in streams.values()]
    if any(len(times) < 2 for times in arrivals):
        raise InputError("an instrument has sent nothing yet", where=str(path), remedy="There is no run in this file")
    origin = _noted_origin(file) or max(float(times[0]) for times in arrivals) + 0.02
    end = min(float(times[-1]) for times in arrivals)
    if end - origin < SHORTEST:
        remedy = f"Less than {SHORTEST} s were recorded: run it again"
        raise InputError("too short", where=str(path), value=f"{max(end - origin, 0.0):.3f} s", remedy=remedy)
    return origin, end


def _noted_origin(file: h5py.File) -> float | None:
    kinds, texts = file["entry/events/kind"][()], file["entry/events/text"][()]
    marks = np.flatnonzero(kinds == b"origin")
    return float(texts[marks[0]].decode()) if len(marks) else None


def _guardian_note(path: Path) -> str:
    note = path.with_suffix(".guardian.json")
    if not note.exists():
        return ""
    found = json.loads(note.read_text())
    why = {"end": "the acquisition process died", "silence": "the acquisition fell silent"}[found["guardian"]]
    confirmed = found["stop_confirmed"]
    if confirmed is None:
        return f"guardian: {why}, the drive did not answer its stop"
    return f"guardian: {why}, the drive was stopped"
