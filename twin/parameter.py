"""The two coins that all plug-ins use: a parameter and a source."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number that a model, a law or a cause has.

    name: as in files and reports. unit: text, of the value as stored and shown. value: nominal, or the null
    (no effect) of a cause. bounds: the range in which it means something. uncertainty: one sigma of what is
    believed before any data, or None. meaning: one clause for the operator.
    """

    name: str
    unit: str
    value: float
    bounds: tuple[float, float] = (-math.inf, math.inf)
    uncertainty: float | None = None
    meaning: str = ""


@dataclass(frozen=True, slots=True)
class Source:
    """Where an equation comes from: "Polach, Hajzman, Dupal", 2020, "eq. 1"; author "assumed" where nowhere."""

    author: str
    year: int | None = None
    equation: str = ""

    def __str__(self) -> str:
        return ", ".join(str(part) for part in (self.author, self.year, self.equation) if part)
