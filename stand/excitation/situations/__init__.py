"""Situations, one TOML file each: the tests that the papers present, as orders for this stand."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

from stand.errors import InputError
from stand.excitation.spec import Excitation, Shape
from stand.units import parse_quantity

FOLDER = Path(__file__).parent


@dataclass(frozen=True, slots=True)
class Situation:
    """A named order. added_mass kg. published: channel -> (R with constant b, R with b(v)), where printed."""

    name: str
    title: str
    source: str
    excitation: Excitation
    added_mass: float
    published: dict[str, tuple[float, float]]


def situations(folder: Path = FOLDER) -> dict[str, Situation]:
    """All situations in the folder, by name, in the papers' order."""
    found = [read_situation(path) for path in folder.glob("*.toml")]
    return {s.name: s for s in sorted(found, key=lambda s: (int("".join(filter(str.isdigit, s.name)) or 0), s.name))}


def read_situation(path: Path) -> Situation:
    """One file; InputError naming file and key."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        order = table["excitation"]
        excitation = Excitation(
            Shape(order["shape"]),
            frequency=parse_quantity(order["frequency"], "Hz", f"{path}: excitation.frequency"),
            amplitude=parse_quantity(order["amplitude"], "m", f"{path}: excitation.amplitude"),
            ramp=parse_quantity(order.get("ramp", 0.0), "s", f"{path}: excitation.ramp"),
            cycles=float(order["cycles"]),
        )
    except (tomllib.TOMLDecodeError, KeyError, ValueError) as error:
        raise InputError(
            f"not a situation ({error})", where=str(path), remedy="See the others in the folder"
        ) from error
    published = {name: (float(pair[0]), float(pair[1])) for name, pair in table.get("published", {}).items()}
    mass = parse_quantity(table.get("added_mass", 0.0), "kg", f"{path}: added_mass")
    return Situation(path.stem, table.get("title", path.stem), table.get("source", ""), excitation, mass, published)
