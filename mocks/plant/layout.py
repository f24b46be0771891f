"""A recording on disk, written with h5py alone from the layout's description."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray

from mocks.plant.operator import Stand
from mocks.plant.rig import LINEAR_DRIVE, WF

Float = NDArray[np.float64]

UNITS = {
    "weight_mass": "kg",
    "added_mass": "kg",
    "incline_angle": "deg",
    "gravity": "m/s^2",
    "fibre_length": "m",
    "fibre_mass": "kg",
    "weight_strand_length": "m",
    "drive_strand_length": "m",
    "pulley_radius": "m",
    "pulley_inertia": "kg*m^2",
    "wrap_angle": "deg",
    "fibre_stiffness": "N/m",
    "fibre_damping": "N*s/m",
    "guide_friction": "N",
    "guide_friction_velocity": "m/s",
    "moving_mass": "kg",
}
CHANNEL_UNITS = {"drive_position": "m", "weight_position": "m", "fibre_force": "N", "drive_force": "N"}
EXCITATION_UNITS = {"frequency": "Hz", "amplitude": "m", "ramp": "s", "drop_height": "m"}


def write(
    path: Path,
    stand: Stand,
    channels: Mapping[str, Float],
    sigma: Mapping[str, float],
    rate: float,
    ordered: Mapping[str, float | str],
) -> Path:
    """One run at `path` (replaced if it is there): channels at `rate` Hz with their noise, setup, excitation."""
    with h5py.File(path, "w") as file:
        file.attrs.update({"NX_class": "NXroot", "default": "entry"})
        entry = file.create_group("entry")
        entry.attrs.update({"NX_class": "NXentry", "default": "data"})
        entry.create_dataset("definition", data="weight-fibre-stand").attrs["version"] = "1"
        _data(entry, channels, sigma, rate)
        _setup(entry, stand)
        if ordered:
            _excitation(entry, ordered)
        events = entry.create_group("events")
        events.attrs.update({"NX_class": "NXcollection", "complete": True})
    return path


def _data(entry: h5py.Group, channels: Mapping[str, Float], sigma: Mapping[str, float], rate: float) -> None:
    data = entry.create_group("data")
    signal = "weight_position" if "weight_position" in channels else "drive_position"
    data.attrs.update({"NX_class": "NXdata", "signal": signal, "axes": "time"})
    data.attrs["auxiliary_signals"] = [name for name in channels if name != signal]
    length = len(channels[signal])
    data.create_dataset("time", data=np.arange(length) / rate).attrs["units"] = "s"
    for name, values in channels.items():
        dataset = data.create_dataset(name, data=values, compression="gzip", compression_opts=1, shuffle=True)
        dataset.attrs["units"] = CHANNEL_UNITS[name]
        dataset.attrs["uncertainty"] = sigma[name]
    data.create_dataset("quality", data=np.zeros(length, np.uint8), compression="gzip")


def _setup(entry: h5py.Group, stand: Stand) -> None:
    group = entry.create_group("setup")
    group.attrs["NX_class"] = "NXcollection"
    group.create_dataset("system", data=stand.believed.system)
    for name in stated(stand.believed.system):
        factor = 180.0 / math.pi if UNITS[name] == "deg" else 1.0
        dataset = group.create_dataset(name, data=factor * getattr(stand.believed, name))
        dataset.attrs["units"] = UNITS[name]
        if name in stand.uncertainty:
            dataset.attrs["uncertainty"] = factor * stand.uncertainty[name]


def stated(system: str) -> list[str]:
    """The setup values that a recording of such a rig states."""
    if system == LINEAR_DRIVE:
        return ["moving_mass"]
    absent = ("pulley", "drive", "wrap", "moving") if system == WF else ("moving",)
    return [name for name in UNITS if name.split("_")[0] not in absent]


def _excitation(entry: h5py.Group, ordered: Mapping[str, float | str]) -> None:
    group = entry.create_group("excitation")
    group.attrs["NX_class"] = "NXcollection"
    for name, value in ordered.items():
        dataset = group.create_dataset(name, data=value)
        if name in EXCITATION_UNITS:
            dataset.attrs["units"] = EXCITATION_UNITS[name]
