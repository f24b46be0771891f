"""Read anyone's recording that has `/entry/data` and `/entry/setup`."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType

import h5py
import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError
from stand.excitation.spec import Excitation, Shape
from stand.recording.model import CHANNELS, Channel, Float, Recording
from stand.setup import SCALARS, Setup, System, check, nominal
from stand.units import conversion

MINIMUM_REST = 0.4
SAME = "Every channel has one value for each time"
_OPTIONAL = frozenset({"lateral_offset", "moving_mass"})


def read_recording(path: Path | str) -> Recording:
    """The recording at `path` in SI; InputError naming file, key, value and remedy where it can't be read."""
    path = Path(path)
    if not path.exists():
        raise InputError("no such file", where=str(path), remedy="Check the path")
    if path.is_dir():
        raise InputError("is a folder", where=str(path), remedy="Name the recordings in it, as with runs/*.h5")
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise InputError(
            f"not a readable HDF5 file ({error})",
            where=str(path),
            remedy="If a run was cut off while writing it, try `stand doctor --recover FILE`",
        ) from error
    with file:
        return _read(file, path)


def _read(file: h5py.File, path: Path) -> Recording:
    entry = _group(file, "entry", path)
    setup_group, data = _group(entry, "setup", path), _group(entry, "data", path)
    notes: list[str] = []
    setup = _read_setup(setup_group, path, notes)
    time = _read_array(data, "time", "s", path)
    channels = {c.name: _read_array(data, c.name, c.unit, path) for c in CHANNELS[setup.system]}
    _check_lengths(time, channels, path)
    return Recording(
        path=path,
        setup=setup,
        time=_uniform(time, path, _rounding(data["time"], time)),
        channels=MappingProxyType(channels),
        excitation=_read_excitation(entry, path),
        uncertainty=_read_uncertainties(data, CHANNELS[setup.system], path),
        quality=_read_quality(data, len(time), path),
        complete=_read_complete(entry),
        notes=tuple(notes),
    )


def _group(parent: h5py.Group, name: str, path: Path) -> h5py.Group:
    group = parent.get(name)
    if not isinstance(group, h5py.Group):
        where = f"{path}:{parent.name.rstrip('/')}/{name}"
        raise InputError("missing group", where=where, remedy="A recording needs /entry/data and /entry/setup")
    return group


def _dataset(group: h5py.Group, name: str, path: Path) -> h5py.Dataset:
    dataset = group.get(name)
    if not isinstance(dataset, h5py.Dataset):
        raise InputError("missing", where=f"{path}:{group.name}/{name}", remedy="Write it, with its @units")
    return dataset


def _units(dataset: h5py.Dataset, path: Path) -> str:
    units = dataset.attrs.get("units")
    if units is None:
        where = f"{path}:{dataset.name}"
        raise InputError("no @units", where=where, remedy='Units are read, not assumed: add the attribute, e.g. "mm"')
    return _word(units)


def _word(value: object) -> str:
    """A string as h5py gives it: str, bytes, or an array of one of either."""
    first = np.asarray(value).reshape(-1)[0]
    return first.decode() if isinstance(first, bytes) else str(first)


def _read_array(group: h5py.Group, name: str, like: str, path: Path) -> Float:
    dataset = _dataset(group, name, path)
    where = f"{path}:{dataset.name}"
    if dataset.ndim != 1 or dataset.dtype.kind not in "fiu":
        remedy = "Write it as numbers, one a sample"
        raise InputError("not a series of numbers", where=where, value=f"{dataset.dtype}{dataset.shape}", remedy=remedy)
    values: Float = dataset[:].astype(np.float64) * conversion(_units(dataset, path), like, where)
    return values


def _read_scalar(dataset: h5py.Dataset, like: str, path: Path) -> float:
    where = f"{path}:{dataset.name}"
    value = np.asarray(dataset[()])
    if value.size != 1 or value.dtype.kind not in "fiu":
        raise InputError(
            "not a single number", where=where, value=dataset[()], remedy="Write one number, with its @units"
        )
    return float(value.reshape(-1)[0]) * conversion(_units(dataset, path), like, where)


def _read_uncertainty(dataset: h5py.Dataset, like: str, path: Path) -> float | None:
    stated = dataset.attrs.get("uncertainty")
    if stated is None:
        return None
    where = f"{path}:{dataset.name}@uncertainty"
    sigma = float(np.asarray(stated).reshape(-1)[0])
    if not (np.isfinite(sigma) and sigma >= 0):
        remedy = "One sigma, in the value's own unit"
        raise InputError("must be a number of 0 or more", where=where, value=sigma, remedy=remedy)
    return sigma * conversion(_units(dataset, path), like, where)


def _read_uncertainties(data: h5py.Group, channels: tuple[Channel, ...], path: Path) -> dict[str, float]:
    read = {c.name: _read_uncertainty(data[c.name], c.unit, path) for c in channels}
    return {name: sigma for name, sigma in read.items() if sigma is not None}


def _text(dataset: h5py.Dataset) -> str:
    return _word(dataset[()])


def _read_setup(group: h5py.Group, path: Path, notes: list[str]) -> Setup:
    system = _read_system(group, path)
    values: dict[str, float] = {}
    sigmas: dict[str, float] = {}
    for name, unit in SCALARS.items():
        if name not in group:
            continue
        dataset = _dataset(group, name, path)
        values[name] = _read_scalar(dataset, unit, path)
        sigma = _read_uncertainty(dataset, unit, path)
        if sigma is not None:
            sigmas[name] = sigma
    _note_missing(system, values, group, path, notes)
    setup = nominal(system).with_values(**values, uncertainty=MappingProxyType(sigmas))
    setup = _with_curve(setup, group, path)
    _note_lengths(setup, notes)
    return check(setup, f"{path}:{group.name}")


def _read_system(group: h5py.Group, path: Path) -> System:
    text = _text(_dataset(group, "system", path))
    try:
        return System(text)
    except ValueError:
        known = ", ".join(f'"{s}"' for s in System)
        where = f"{path}:{group.name}/system"
        raise InputError("unknown system", where=where, value=text, remedy=f"One of {known}") from None


def _note_missing(system: System, values: dict[str, float], group: h5py.Group, path: Path, notes: list[str]) -> None:
    if system is System.LINEAR_DRIVE:
        if "moving_mass" not in values:
            raise InputError("missing", where=f"{path}:{group.name}/moving_mass", remedy="State the mass that moves")
        return
    missing = [n for n in SCALARS if n not in values and n not in _OPTIONAL]
    if "weight_mass" in missing or "incline_angle" in missing:
        raise InputError(
            "missing",
            where=f"{path}:{group.name}/{missing[0]}",
            remedy="The setup must say what was weighed and set",
        )
    if missing:
        notes.append(f"setup does not state {', '.join(missing)}: nominal values are used")


def _note_lengths(setup: Setup, notes: list[str]) -> None:
    if setup.system is not System.WFPD:
        return
    expected = setup.free_length + setup.pulley_radius * setup.wrap_angle
    if abs(setup.fibre_length - expected) > 0.01 * expected:
        notes.append(
            f"fibre_length {setup.fibre_length:.4f} m disagrees with the strands and the arc ({expected:.4f} m): "
            "the strands' lengths are what counts"
        )


def _with_curve(setup: Setup, group: h5py.Group, path: Path) -> Setup:
    if "guide_friction_curve" not in group:
        return setup
    curve = np.asarray(group["guide_friction_curve"][()], dtype=np.float64)
    if curve.ndim != 2 or curve.shape[1] != 2 or np.any(np.diff(curve[:, 0]) <= 0):
        where = f"{path}:{group.name}/guide_friction_curve"
        raise InputError("must be [k, 2] (m/s, N) with rising speeds", where=where, value=curve.shape)
    return setup.with_values(guide_friction_curve=curve)


def _check_lengths(time: Float, channels: dict[str, Float], path: Path) -> None:
    for name, values in channels.items():
        if len(values) != len(time):
            where = f"{path}:/entry/data/{name}"
            raise InputError(f"{len(values)} samples against {len(time)} of time", where=where, remedy=SAME)
    if len(time) < 3:
        raise InputError("too short", where=f"{path}:/entry/data/time", value=f"{len(time)} samples", remedy=SAME)


def _rounding(dataset: h5py.Dataset, time: Float) -> float:
    """How far a time may be off because of the type that it is written in, s."""
    kind, longest = dataset.dtype, float(np.max(np.abs(time)))
    if kind.kind == "f":
        return 2 * longest * float(np.finfo(kind).eps)
    return longest / max(1.0, float(np.max(np.abs(dataset[()].astype(np.float64)))))


def _uniform(time: Float, path: Path, rounding: float) -> Float:
    """The time axis, or InputError where it is not uniform to a hundredth of a sample and the rounding of its type."""
    where = f"{path}:/entry/data/time"
    if not np.all(np.isfinite(time)):
        at = int(np.flatnonzero(~np.isfinite(time))[0])
        raise InputError(
            f"sample {at} is not a number", where=where, value=float(time[at]), remedy="Write every time, in s"
        )
    step = (time[-1] - time[0]) / (len(time) - 1)
    if step <= 0:
        remedy = "Put the samples in the order of time"
        raise InputError("time does not rise", where=where, value=float(step), remedy=remedy)
    off = np.abs(np.diff(time) - step)
    if off.max() > 0.01 * step + rounding:
        at = int(off.argmax())
        raise InputError(
            f"time is not uniform: step {at} is {time[at + 1] - time[at]:.6g} s, the mean {step:.6g} s",
            where=where,
            remedy="Resample the channels to one uniform grid, or use `stand import`",
        )
    return time if rounding < 1e-9 else time[0] + step * np.arange(len(time))


def _read_quality(data: h5py.Group, length: int, path: Path) -> NDArray[np.uint8] | None:
    if "quality" not in data:
        return None
    quality: NDArray[np.uint8] = np.asarray(data["quality"][()], dtype=np.uint8)
    if quality.shape != (length,):
        raise InputError("wrong length", where=f"{path}:{data.name}/quality", value=quality.shape, remedy=SAME)
    return quality


def _read_excitation(entry: h5py.Group, path: Path) -> Excitation | None:
    group = entry.get("excitation")
    if not isinstance(group, h5py.Group) or "shape" not in group:
        return None
    text = _text(group["shape"])
    if text not in set(Shape):
        raise InputError("unknown shape", where=f"{path}:{group.name}/shape", value=text, remedy=", ".join(Shape))
    units = {"frequency": "Hz", "amplitude": "m", "ramp": "s", "drop_height": "m"}
    values = {name: _read_scalar(group[name], unit, path) for name, unit in units.items() if name in group}
    if "cycles" in group:
        values["cycles"] = float(np.asarray(group["cycles"][()]).reshape(-1)[0])
    return Excitation(shape=Shape(text), **values)


def _read_complete(entry: h5py.Group) -> bool | None:
    events = entry.get("events")
    if not isinstance(events, h5py.Group):
        return None
    complete = events.attrs.get("complete", events["complete"][()] if "complete" in events else None)
    return None if complete is None else bool(complete)
