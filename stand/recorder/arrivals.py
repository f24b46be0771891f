"""The raw streams as the file keeps them, read back for alignment."""

from __future__ import annotations

import h5py
import numpy as np

from stand.clock.model import GaugeStream, RingStream

Stream = GaugeStream | RingStream


def read_streams(file: h5py.File) -> dict[str, Stream]:
    """Every instrument's raw stream; ends that a killed writer left uneven are cut to the shortest."""
    return {name: read_stream(group) for name, group in file["entry/instruments"].items()}


def read_stream(group: h5py.Group) -> Stream:
    """One instrument's raw stream."""
    if "registers" in group:
        k = min(len(group[name]) for name in ("registers", "request_time", "response_time"))
        return RingStream(group["registers"][:k], group["request_time"][:k], group["response_time"][:k])
    k = min(len(group["arrival_time"]), len(group["arrival_bytes"]))
    sizes = group["arrival_bytes"][:k].astype(np.int64)
    whole = int(np.searchsorted(np.cumsum(sizes), len(group["raw"]), side="right"))
    sizes = sizes[:whole]
    return GaugeStream(group["raw"][: int(sizes.sum())], group["arrival_time"][:whole], sizes)
