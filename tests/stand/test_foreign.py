"""Recordings by programs that are not ours: whatever h5py can write that states its units is read."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest

from stand.recording import Recording, read_recording

T = np.arange(24000) / 2000
X = 0.01 * np.sin(6 * T) ** 2


def foreign(path: Path, time: tuple[np.ndarray, object]) -> Recording:
    """Floats of 4 bytes in either order, chunks, packing, units as bytes and arrays, and much beside."""
    with h5py.File(path, "w", libver="latest") as file:
        data = file.create_group("entry/data", track_order=True)
        columns = {
            "fibre_force": ((15.2 + 1e-3 * X).astype(">f4"), np.bytes_("N")),
            "weight_position": (np.round(X * 1e7).astype(np.int32) * 1e-4, np.array([b"mm"])),
            "time": time,
            "drive_position": ((1e3 * X).astype("f4"), "mm"),
        }
        for name, (values, unit) in columns.items():
            made = data.create_dataset(name, data=values, chunks=(1000,), compression="lzf", maxshape=(None,))
            made.attrs["units"] = unit
        data.create_dataset("temperature", data=np.full(7, 21.5))
        data.create_group("more")["x"] = 1
        file.create_group("logs")["operator"] = "somebody"
        setup = file.create_group("entry/setup")
        setup["system"] = np.array([b"weight-fibre-pulley-drive"])
        setup["remark"] = "a text"
        for name, value, unit in (("weight_mass", 3096, b"g"), ("incline_angle", np.pi / 6, "rad")):
            setup[name] = np.array([value])
            setup[name].attrs["units"] = unit
        setup["weight_mass"].attrs["uncertainty"] = np.float32(2.0)
    return read_recording(path)


@pytest.mark.parametrize(
    "time",
    [
        (np.round(T * 1e6).astype(np.int64), np.array(["us"], dtype=object)),
        (T.astype(np.float32), b"s"),
        (1e3 * T + 1.7e12, "ms"),
    ],
    ids=["whole microseconds", "four bytes", "since 1970"],
)
def test_it_is_read_in_si(tmp_path: Path, time: tuple[np.ndarray, object]) -> None:
    recording = foreign(tmp_path / "foreign.h5", time)
    assert recording.dt == pytest.approx(5e-4, rel=1e-6)
    assert np.diff(recording.time) == pytest.approx(5e-4, rel=2e-3)
    assert recording.x == pytest.approx(X, abs=1e-9)
    assert recording.u == pytest.approx(X, abs=1e-7)
    assert pytest.approx(15.2, abs=1e-4) == recording.F
    assert recording.setup.weight_mass == pytest.approx(3.096)
    assert recording.setup.uncertainty["weight_mass"] == pytest.approx(0.002)
    assert recording.complete is None
