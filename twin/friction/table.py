"""Friction as a table of (v, F) points, linear between them and constant beyond (S0, Fig. 7)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from stand.errors import InputError
from twin.friction import Float, FrictionLaw
from twin.parameter import Parameter, Source

_SPEEDS = (-0.1, -0.01, -0.001, 0.001, 0.01, 0.1)
_FORCES = (-3.0, -3.3, -3.6, 3.6, 3.3, 3.0)


def _parameters() -> tuple[Parameter, ...]:
    speeds = (Parameter(f"v{i}", "m/s", v, (-10.0, 10.0), None, f"speed of point {i}") for i, v in enumerate(_SPEEDS))
    forces = (Parameter(f"F{i}", "N", f, (-1e4, 1e4), None, f"friction at point {i}") for i, f in enumerate(_FORCES))
    return tuple(p for pair in zip(speeds, forces, strict=True) for p in pair)


def pack_curve(curve: Float) -> Float:
    """A curve [k, 2] (m/s, N) as the law's constants, float64 [2 k]; InputError unless its speeds rise."""
    curve = np.asarray(curve, dtype=np.float64)
    if curve.ndim != 2 or curve.shape[1] != 2 or len(curve) < 2 or np.any(np.diff(curve[:, 0]) <= 0):
        raise InputError("must be [k, 2] (m/s, N) with rising speeds", where="friction table", value=curve.shape)
    return np.ascontiguousarray(curve).reshape(-1)


def _pack(values: Mapping[str, float]) -> Float:
    points = [values.get(p.name, p.value) for p in _parameters()]
    return pack_curve(np.array(points).reshape(-1, 2))


def _load() -> tuple[Any, Any]:
    from twin.kernels import friction

    return friction.table, friction.no_state


LAW = FrictionLaw(
    name="table",
    title="(v, F) table",
    source=Source("Polach, Hajzman, Bulin", 2020, "Fig. 7; its values are assumed"),
    parameters=_parameters(),
    state=(),
    pack=_pack,
    load=_load,
)
