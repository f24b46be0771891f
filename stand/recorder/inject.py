"""A replay's streams with the recorded arrivals in place of its own, once their content was found equal."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np

from stand.errors import InputError
from stand.recorder.arrivals import Stream, read_streams


def injected(replayed: Path, source: Path) -> dict[str, Stream]:
    """The source's raw streams; InputError naming the first instrument whose replay brought something else.

    A gauge's bytes must be the same bytes; the drive's counted samples must be the same samples (how they were
    spread over the reads is a matter of time, which is what gets replaced).
    """
    with h5py.File(replayed, "r") as ours, h5py.File(source, "r") as theirs:
        for name, group in theirs["entry/instruments"].items():
            other = ours.get(f"entry/instruments/{name}")
            if other is None:
                raise InputError("was not replayed", where=f"{source}:{name}")
            compare = _compare_ring if "registers" in group else _compare_bytes
            compare(other, group, f"{source}:{name}")
        return read_streams(theirs)


def _compare_bytes(ours: h5py.Group, theirs: h5py.Group, where: str) -> None:
    got, sent = ours["raw"][()], theirs["raw"][()]
    n = min(len(got), len(sent))
    differ = np.flatnonzero(got[:n] != sent[:n])
    if len(differ):
        raise InputError("the replay brought other bytes", where=where, value=f"from byte {differ[0]} on")
    if len(got) != len(sent):
        raise InputError("the replay is not whole", where=where, value=f"{len(got)} of {len(sent)} bytes")


def _compare_ring(ours: h5py.Group, theirs: h5py.Group, where: str) -> None:
    got = dict(zip(ours["ticks"][()].tolist(), ours["values"][()].tolist(), strict=True))
    sent = dict(zip(theirs["ticks"][()].tolist(), theirs["values"][()].tolist(), strict=True))
    missing = [tick for tick in sent if tick not in got]
    if missing:
        raise InputError("the replay is not whole", where=where, value=f"{len(missing)} of {len(sent)} samples missing")
    other = [tick for tick, value in sent.items() if got[tick] != value]
    if other:
        raise InputError("the replay brought other values", where=where, value=f"from sample {other[0]} on")
