"""Keep with a recording what the live twin used and said."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError
from twin.live.twin import LiveTwin

Float = NDArray[np.float64]

UNITS = {"time": "s", "x": "m", "u": "m", "F": "N", "simulated_u": "m", "simulated_F": "N"}


def store_live(path: Path | str, twin: LiveTwin) -> None:
    """Writes `/entry/live` into the closed recording at `path`: the twin's samples and its last scores."""
    import h5py

    score = twin.finish()
    with h5py.File(path, "r+") as file:
        entry = file["entry"]
        if "live" in entry:
            del entry["live"]
        group = entry.create_group("live")
        group.attrs.update({"NX_class": "NXcollection", "model": twin.model.name, "dropped": twin.dropped})
        for name, values in twin.samples().items():
            packed = group.create_dataset(name, data=values, compression="gzip", shuffle=True)
            packed.attrs["units"] = UNITS[name]
        for channel, track in (("u", score.u), ("F", score.F)):
            for key in ("R", "nrmse", "lag", "short_error"):
                value = getattr(track, key)
                if math.isfinite(value):
                    group.attrs[f"{channel}_{key}"] = value


def read_live(path: Path | str) -> dict[str, Float]:
    """The samples that `store_live` kept; InputError where there are none."""
    import h5py

    with h5py.File(path, "r") as file:
        group = file.get("entry/live")
        if group is None:
            raise InputError("no live samples", where=str(path), remedy="Only a run with a live twin has them")
        return {name: group[name][:] for name in UNITS}
