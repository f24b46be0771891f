"""What a simulated stand may hide: one file per effect, found by looking in this folder."""

from __future__ import annotations

import importlib
import math
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

Value = float | str


@dataclass(frozen=True, slots=True)
class Size:
    """A parameter of an effect: its unit in files, its default, its null and the range that sizes are drawn from.

    signed: drawn with either sign. steady: kept at a plain uniform draw (phases, places), not part of the size.
    """

    name: str
    unit: str
    default: Value
    low: float = math.nan
    high: float = math.nan
    null: float = 0.0
    signed: bool = False
    steady: bool = False
    choices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Effect:
    """One way in which the simulated stand departs from its operator's belief.

    acts_on: the catalogue's word for where. act(world, **parameters) builds it into a world, values in the units of
    `sizes`. depends_on: for what is in no catalogue, the names on which its force or error truly depends; else empty.
    systems: the rigs that can have it.
    """

    name: str
    acts_on: str
    sizes: tuple[Size, ...]
    act: Callable[..., None]
    depends_on: tuple[str, ...] = ()
    systems: tuple[str, ...] = ("weight-fibre-pulley-drive",)

    @property
    def catalogued(self) -> bool:
        """Whether the catalogue has it."""
        return not self.depends_on

    def complete(self, values: Mapping[str, Value]) -> dict[str, Any]:
        """Every parameter, defaults where not given; ValueError for one that the effect does not have."""
        known = {size.name: size.default for size in self.sizes}
        for name in values:
            if name not in known:
                raise ValueError(f"{self.name} has no parameter {name!r}; it has {', '.join(known)}")
        return known | dict(values)

    def null(self) -> dict[str, Any]:
        """Parameters at which it does nothing."""
        return {s.name: s.default if s.choices or s.steady else s.null for s in self.sizes}


def names() -> list[str]:
    """Every effect's name, from the files in this folder."""
    return sorted(m.name.replace("_", "-") for m in pkgutil.iter_modules(__path__))


def find(name: str) -> Effect:
    """The effect of that name; KeyError naming those there are."""
    if name not in names():
        raise KeyError(f"no effect {name!r}; there are {', '.join(names())}")
    effect: Effect = importlib.import_module(f"{__name__}.{name.replace('-', '_')}").EFFECT
    return effect


def everything() -> list[Effect]:
    """All effects in alphabetical order."""
    return [find(name) for name in names()]
