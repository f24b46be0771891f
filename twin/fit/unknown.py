"""What can be tuned: the setup's values and the model's own parameters, by name."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError
from stand.setup import SCALARS, Setup
from stand.units import conversion
from twin.model import FibreModel

Float = NDArray[np.float64]

_NOT_TUNED = frozenset({"moving_mass", "fibre_length", "lateral_offset"})


@dataclass(frozen=True, slots=True)
class Unknown:
    """One tuned value in SI. own: it is the model's own, not the setup's. sigma: believed before the data, or NaN."""

    name: str
    unit: str
    value: float
    bounds: tuple[float, float]
    sigma: float
    own: bool

    @property
    def step(self) -> float:
        """A change small enough to be linear and large enough to be seen."""
        return 2e-3 * (abs(self.value) or (self.bounds[1] if math.isfinite(self.bounds[1]) else 1.0))

    @property
    def factor(self) -> float:
        """SI per shown unit."""
        return 1.0 if self.own else conversion(self.unit, self.unit)


def unknowns(setup: Setup, model: FibreModel, names: Sequence[str]) -> tuple[Unknown, ...]:
    """The named values; InputError naming one that neither the setup nor the model has, or listed twice."""
    if not names:
        raise InputError("nothing to tune", where="parameters", remedy="Name at least one parameter")
    if len(set(names)) < len(names):
        raise InputError("named twice", where="parameters", value=list(names))
    return tuple(_unknown(setup, model, name) for name in names)


def _unknown(setup: Setup, model: FibreModel, name: str) -> Unknown:
    own = {p.name: p for p in model.parameters}
    if name in own:
        p = own[name]
        return Unknown(name, p.unit, p.value, p.bounds, p.uncertainty or math.nan, True)
    value = getattr(setup, name, None) if name in SCALARS and name not in _NOT_TUNED else None
    if value is None:
        known = ", ".join([*(n for n in SCALARS if n not in _NOT_TUNED), *own])
        raise InputError("no such parameter", where=f"{model.name}/parameters", value=name, remedy=f"Known: {known}")
    low, high = (0.05 * value, 20.0 * value) if value > 0 else (0.0, 1.0)
    if name.endswith("_angle"):
        low, high = max(value - 0.2, 0.0), value + 0.2
    return Unknown(name, SCALARS[name], float(value), (low, high), setup.sigma(name), False)


def applied(setup: Setup, chosen: Sequence[Unknown], values: Float) -> tuple[Setup, dict[str, float]]:
    """The setup and the model's parameters with `values` in them."""
    pairs = list(zip(chosen, values, strict=True))
    changed = setup.with_values(**{u.name: float(v) for u, v in pairs if not u.own})
    return changed, {u.name: float(v) for u, v in pairs if u.own}
