"""A recording from columns of numbers and a setup, whoever measured them."""

from __future__ import annotations

import csv
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError
from stand.excitation.spec import Excitation, Shape
from stand.recording.model import CHANNELS, Channel, Float, Quality, Recording
from stand.recording.write import write_recording
from stand.setup import Setup
from stand.setup_table import read_setup
from stand.units import conversion, parse_quantity

GRID = 1 / 2000.0
ALL_CHANNELS = Quality.DRIVE_POSITION | Quality.WEIGHT_POSITION | Quality.FIBRE_FORCE
_HEADING = re.compile(r"^\s*(?P<name>[^\[(/]+?)\s*(?:[\[(/]\s*(?P<unit>[^\])]+?)\s*[\])]?)?\s*$")
_ALIASES = {"t": "time", "x": "drive_position", "u": "weight_position", "f": "fibre_force"}
_DELIMITERS = ";\t,"
_UNITS = {"frequency": "Hz", "amplitude": "m", "ramp": "s", "cycles": "1", "drop_height": "m"}


def import_csv(table: Path | str, setup: Path | str, out: Path | str | None = None) -> Path:
    """Write the recording of a CSV file and a setup in TOML, by default beside the table; returns its path.

    The CSV's first line names the columns with their units, `time [s]; x [mm]; u [mm]; F [N]` or their long names.
    The TOML has `[setup]` as in a stand's file and may have `[excitation]` and `[columns]` (heading = channel).
    A time axis that is not uniform is resampled to 2 kHz by straight lines; where no sample is within one usual step,
    `quality` marks all channels. InputError names file, line and column.
    """
    table, setup = Path(table), Path(setup)
    tables = _read_toml(setup)
    stand_setup = read_setup(_section(tables, "setup", setup), f"{setup}: setup")
    columns = _read_columns(table, tables.get("columns", {}))
    time, channels = _channels(columns, CHANNELS[stand_setup.system], table)
    path = Path(out) if out is not None else table.with_suffix(".h5")
    if path.exists():
        raise InputError("exists already", where=str(path), remedy="Name another file with --out")
    return write_recording(_recording(time, channels, stand_setup, _excitation(tables, setup)), path)


def _recording(time: Float, channels: dict[str, Float], setup: Setup, excitation: Excitation | None) -> Recording:
    step, quality = np.diff(time), None
    if np.any(np.abs(step - step.mean()) > 0.01 * step.mean()):
        grid = time[0] + GRID * np.arange(int((time[-1] - time[0]) / GRID + 1e-9) + 1)
        channels = {name: np.interp(grid, time, values) for name, values in channels.items()}
        quality = _far(time, grid, float(np.median(step)))
        time = grid
    return Recording(None, setup, time - time[0], channels, excitation, quality=quality)


def _far(time: Float, grid: Float, step: float) -> NDArray[np.uint8]:
    """Quality [n]: all channels' bits where the nearest sample is farther away than a usual step, s."""
    right = np.clip(np.searchsorted(time, grid), 1, len(time) - 1)
    nearest = np.minimum(np.abs(time[right] - grid), np.abs(grid - time[right - 1]))
    marked: NDArray[np.uint8] = np.where(nearest > 1.001 * max(step, GRID), ALL_CHANNELS, 0).astype(np.uint8)
    return marked


def _read_toml(path: Path) -> Mapping[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"can't be read ({error.strerror})", where=str(path), remedy="Check the path") from error
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"not valid TOML: {error}", where=str(path), remedy="Mend the line that it names") from error


def _section(tables: Mapping[str, Any], name: str, path: Path) -> Mapping[str, Any]:
    section = tables.get(name)
    if not isinstance(section, Mapping):
        raise InputError("missing", where=f"{path}: [{name}]", remedy="Say what the columns were measured on")
    return section


def _excitation(tables: Mapping[str, Any], path: Path) -> Excitation | None:
    section = tables.get("excitation")
    if section is None:
        return None
    where, shape = f"{path}: excitation", section.get("shape")
    if shape not in set(Shape):
        raise InputError("unknown shape", where=f"{where}.shape", value=shape, remedy=", ".join(Shape))
    given = {k: parse_quantity(section[k], unit, f"{where}.{k}") for k, unit in _UNITS.items() if k in section}
    return Excitation(Shape(shape), **given)


def _read_columns(path: Path, renamed: Mapping[str, str]) -> dict[str, Float]:
    """channel name -> SI values [n], for every column whose heading names a known channel."""
    lines = _read_lines(path)
    delimiter = max(_DELIMITERS, key=lines[0].count)
    rows = list(csv.reader(lines, delimiter=delimiter))
    values = _numbers(rows[1:], len(rows[0]), path, decimal_comma=delimiter != ",")
    units = {c.name: c.unit for channels in CHANNELS.values() for c in channels} | {"time": "s"}
    columns: dict[str, Float] = {}
    for index, heading in enumerate(rows[0]):
        name, unit = _heading(heading, renamed)
        if name not in units:
            continue
        where = f"{path}: column {heading.strip()!r}"
        if unit is None:
            remedy = f'Head it like "{name} [{units[name]}]"'
            raise InputError("states no unit", where=where, remedy=remedy)
        columns[name] = values[:, index] * conversion(unit, units[name], where)
    return columns


def _read_lines(path: Path) -> list[str]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"can't be read ({error})", where=str(path), remedy="Give a CSV file in UTF-8") from error
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if len(lines) < 4:
        raise InputError("too short", where=str(path), value=f"{len(lines)} lines", remedy="A heading and samples")
    return lines


def _heading(text: str, renamed: Mapping[str, str]) -> tuple[str, str | None]:
    match = _HEADING.match(text)
    if match is None:
        return text, None
    name = renamed.get(match["name"], match["name"])
    return _ALIASES.get(name.lower(), name), match["unit"]


def _numbers(rows: Sequence[Sequence[str]], width: int, path: Path, *, decimal_comma: bool) -> Float:
    values = np.empty((len(rows), width))
    for number, row in enumerate(rows):
        where = f"{path}: sample {number + 1}"
        if len(row) != width:
            raise InputError(f"{len(row)} columns against {width}", where=where, remedy="Mend or remove the line")
        try:
            values[number] = [float(cell.replace(",", ".") if decimal_comma else cell) for cell in row]
        except ValueError as error:
            raise InputError(str(error), where=where, remedy="Only numbers below the heading") from error
    if not np.isfinite(values).all():
        bad = int(np.argwhere(~np.isfinite(values))[0][0])
        raise InputError("not a finite number", where=f"{path}: sample {bad + 1}", remedy="Remove or mend the line")
    return values


def _channels(columns: dict[str, Float], wanted: tuple[Channel, ...], path: Path) -> tuple[Float, dict[str, Float]]:
    for name, unit in (("time", "s"), *((c.name, c.unit) for c in wanted)):
        if name not in columns:
            remedy = f'Head one column "{name} [{unit}]", or name it in [columns] of the setup'
            raise InputError("no such column", where=f"{path}: {name}", remedy=remedy)
    time = columns["time"]
    if np.any(np.diff(time) <= 0):
        at = int(np.argmax(np.diff(time) <= 0))
        where, remedy = f"{path}: sample {at + 2}", "Put the lines in the order of time, each time once"
        raise InputError("time does not rise", where=where, value=float(time[at + 1]), remedy=remedy)
    return time, {c.name: columns[c.name] for c in wanted}
