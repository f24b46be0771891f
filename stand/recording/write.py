"""Write a whole recording at once: imports, simulations, derived runs. The live recorder has its own writer."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import h5py
import numpy as np

from stand.excitation.spec import Excitation
from stand.recording.model import CHANNELS, Recording
from stand.setup import SCALARS, Setup
from stand.targets import check_target
from stand.units import conversion

DEFINITION, VERSION = "weight-fibre-stand", "1"


def write_recording(recording: Recording, path: Path) -> Path:
    """Write `recording` to `path` in the layout of `recording.md` and return the path; it must not exist."""
    with h5py.File(check_target(path), "x") as file:
        entry = write_entry(file)
        write_data(entry, recording)
        write_setup(entry, recording.setup)
        if recording.excitation is not None:
            write_excitation(entry, recording.excitation)
        events = entry.create_group("events")
        events.attrs["NX_class"] = "NXcollection"
        events.attrs["complete"] = True
    return path


def write_entry(file: h5py.File) -> h5py.Group:
    """The root, `/entry` and its definition; returns `/entry`."""
    file.attrs.update({"NX_class": "NXroot", "default": "entry"})
    entry = file.create_group("entry")
    entry.attrs.update({"NX_class": "NXentry", "default": "data"})
    definition = entry.create_dataset("definition", data=DEFINITION)
    definition.attrs["version"] = VERSION
    return entry


def write_data(entry: h5py.Group, recording: Recording) -> h5py.Group:
    """`/entry/data` with time, the system's channels and quality, compressed."""
    data = entry.create_group("data")
    _data_attributes(data, recording)
    packing = {"compression": "gzip", "compression_opts": 4, "shuffle": True}
    data.create_dataset("time", data=recording.time, **packing).attrs["units"] = "s"
    for channel in CHANNELS[recording.setup.system]:
        dataset = data.create_dataset(channel.name, data=recording.channels[channel.name], **packing)
        dataset.attrs["units"] = channel.unit
        if channel.name in recording.uncertainty:
            dataset.attrs["uncertainty"] = recording.uncertainty[channel.name]
    if recording.quality is not None:
        data.create_dataset("quality", data=recording.quality.astype(np.uint8), **packing)
    return data


def _data_attributes(data: h5py.Group, recording: Recording) -> None:
    names = [channel.name for channel in CHANNELS[recording.setup.system]]
    signal = "weight_position" if "weight_position" in names else names[0]
    data.attrs.update({"NX_class": "NXdata", "signal": signal, "axes": "time"})
    data.attrs["auxiliary_signals"] = [name for name in names if name != signal]


def write_setup(entry: h5py.Group, setup: Setup) -> h5py.Group:
    """`/entry/setup`: every scalar in the unit of `recording.md`, with its uncertainty where one is stated."""
    group = entry.create_group("setup")
    group.attrs["NX_class"] = "NXcollection"
    group.create_dataset("system", data=str(setup.system))
    for name, unit in SCALARS.items():
        value = getattr(setup, name)
        if value is None:
            continue
        factor = conversion(unit, unit)
        dataset = group.create_dataset(name, data=value / factor)
        dataset.attrs["units"] = unit
        if name in setup.uncertainty:
            dataset.attrs["uncertainty"] = setup.uncertainty[name] / factor
    if setup.guide_friction_curve is not None:
        group.create_dataset("guide_friction_curve", data=setup.guide_friction_curve).attrs["units"] = "m/s, N"
    return group


def write_excitation(entry: h5py.Group, excitation: Excitation) -> h5py.Group:
    """`/entry/excitation` as ordered."""
    units = {"frequency": "Hz", "amplitude": "m", "ramp": "s", "cycles": "1", "drop_height": "m"}
    group = entry.create_group("excitation")
    group.attrs["NX_class"] = "NXcollection"
    for name, value in dataclasses.asdict(excitation).items():
        dataset = group.create_dataset(name, data=str(value) if name == "shape" else value)
        if name in units:
            dataset.attrs["units"] = units[name]
    return group
