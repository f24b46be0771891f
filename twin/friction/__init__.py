"""Dry-friction laws as plug-ins: F(v, z, applied) with at most one inner state z; F opposes the motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError
from twin.parameter import Parameter, Source

Float = NDArray[np.float64]

#: numba signatures of the two compiled functions of a law (z: inner state, m; p: the packed constants)
FORCE = "float64(float64, float64, float64, float64[::1])"  # v, z, applied, p -> F, N
RATE = "float64(float64, float64, float64[::1])"  # v, z, p -> dz/dt, m/s


@dataclass(frozen=True)
class FrictionLaw:
    """One law (a plug-in: one instance in one file).

    state: names of the inner state (none or one). pack(values): the constants, float64 [k], those left out
        nominal. load(): the compiled (force, rate): force(v, z, applied, p) in N, positive against positive v;
        `applied` is the sum of all other forces on the body, which only a law with true stick looks at.
        rate(v, z, p) is dz/dt in m/s, 0 for a law without state. Both are numba functions, callable from Python.
    """

    name: str
    title: str
    source: Source
    parameters: tuple[Parameter, ...]
    state: tuple[str, ...]
    pack: Callable[[Mapping[str, float]], Float]
    load: Callable[[], tuple[Any, Any]]


def packed(parameters: tuple[Parameter, ...], values: Mapping[str, float]) -> Float:
    """The parameters' values in their order, float64 [k]; InputError naming one that is unknown or out of bounds."""
    known = {p.name: p for p in parameters}
    for name, value in values.items():
        if name not in known:
            raise InputError("unknown parameter", where=name, value=value, remedy="Known: " + ", ".join(known))
        low, high = known[name].bounds
        if not low <= value <= high:
            raise InputError("out of bounds", where=name, value=value, remedy=f"Keep it within {low:g} and {high:g}")
    return np.array([values.get(p.name, p.value) for p in parameters], dtype=np.float64)
