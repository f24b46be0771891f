"""Units are read, not assumed: SI, its usual multiples, deg and rad; anything else is refused by name."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from stand.errors import InputError

#: dimension exponents (kg, m, s); an angle counts as a number
Dimension = tuple[int, int, int]

_PREFIX = {
    "": 1.0,
    "k": 1e3,
    "d": 1e-1,
    "c": 1e-2,
    "m": 1e-3,
    "u": 1e-6,
    "µ": 1e-6,
    "μ": 1e-6,
    "n": 1e-9,
    "M": 1e6,
}
_BASE: dict[str, tuple[float, Dimension, str]] = {
    # name: factor to SI, dimension, prefixes that it takes
    "m": (1.0, (0, 1, 0), "k d c m u µ μ n"),
    "s": (1.0, (0, 0, 1), "m u µ μ n"),
    "min": (60.0, (0, 0, 1), ""),
    "h": (3600.0, (0, 0, 1), ""),
    "g": (1e-3, (1, 0, 0), "k m u µ μ"),
    "N": (1.0, (1, 1, -2), "k m u µ μ M"),
    "Hz": (1.0, (0, 0, -1), "k M"),
    "Pa": (1.0, (1, -1, -2), "k M"),
    "J": (1.0, (1, 2, -2), "k m"),
    "rad": (1.0, (0, 0, 0), "m u µ μ"),
    "deg": (math.pi / 180, (0, 0, 0), ""),
    "°": (math.pi / 180, (0, 0, 0), ""),
    "1": (1.0, (0, 0, 0), ""),
    "-": (1.0, (0, 0, 0), ""),
    "%": (1e-2, (0, 0, 0), ""),
    "ppm": (1e-6, (0, 0, 0), ""),
}
_ATOMS = {
    prefix + name: (_PREFIX[prefix] * factor, dimension)
    for name, (factor, dimension, prefixes) in _BASE.items()
    for prefix in ("", *prefixes.split())
}
_POWERS = str.maketrans({"²": "^2", "³": "^3", "·": "*", "⋅": "*"})
_FACTOR = re.compile(r"^(?P<atom>[^\d^]+|1)(?:\^?(?P<power>-?\d+))?$")
_NUMBER = re.compile(r"^\s*(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(?P<unit>.*?)\s*$")


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit as its text, its factor to SI and its dimension (kg, m, s exponents)."""

    text: str
    factor: float
    dimension: Dimension


def parse_unit(text: str, where: str = "") -> Unit:
    """The unit that `text` names, such as "N*s^2/m^2"; InputError naming the part that is not known."""
    factor, dimension, sign = 1.0, [0, 0, 0], 1
    for token in re.split(r"([*/ ])", text.strip().translate(_POWERS)):
        if token in ("*", " ", ""):
            continue
        if token == "/":
            sign = -1
            continue
        atom, power = _factor(token, text, where)
        scale, exponents = atom
        factor *= scale ** (sign * power)
        dimension = [d + sign * power * e for d, e in zip(dimension, exponents, strict=True)]
    return Unit(text, factor, (dimension[0], dimension[1], dimension[2]))


def _factor(token: str, text: str, where: str) -> tuple[tuple[float, Dimension], int]:
    match = _FACTOR.match(token.strip("()"))
    if match is None or match["atom"] not in _ATOMS:
        raise InputError(
            f"unknown unit {token!r}",
            where=where,
            value=text,
            remedy="Use SI units and their usual multiples (mm, kN, ms, g), deg or rad",
        )
    return _ATOMS[match["atom"]], int(match["power"] or 1)


def to_si(value: float, unit: str, like: str, where: str = "") -> float:
    """`value` in `unit` as SI, having checked that `unit` measures the same thing as `like` does."""
    return value * conversion(unit, like, where)


def conversion(unit: str, like: str, where: str = "") -> float:
    """The factor from `unit` to SI; InputError where `unit` doesn't measure what `like` does."""
    given, wanted = parse_unit(unit, where), parse_unit(like)
    if given.dimension != wanted.dimension:
        raise InputError(
            f"unit {unit!r} does not measure what {like!r} does",
            where=where,
            value=unit,
            remedy=f"Give it in {like} or a multiple of it",
        )
    return given.factor


def parse_quantity(text: str | float, like: str, where: str = "") -> float:
    """ "34 kN/m" or a bare number (taken in `like`) as SI; InputError where it is neither."""
    if isinstance(text, int | float) and not isinstance(text, bool):
        return to_si(float(text), like, like, where)
    match = _NUMBER.match(str(text))
    if match is None:
        raise InputError("not a number with a unit", where=where, value=text, remedy=f'Write it like "1.5 {like}"')
    return to_si(float(match["number"]), match["unit"] or like, like, where)
