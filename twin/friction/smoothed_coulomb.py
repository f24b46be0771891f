"""Smoothed Coulomb friction: F_c tanh(v / v_s)."""

from __future__ import annotations

import functools
from typing import Any

from twin.friction import FrictionLaw, packed
from twin.parameter import Parameter, Source

_PARAMETERS = (
    Parameter("coulomb", "N", 3.0, (0.0, 1e4), None, "dry friction while sliding"),
    Parameter("smoothing", "m/s", 0.002, (1e-9, 1.0), None, "speed at which 76 % of it is reached"),
)


def _load() -> tuple[Any, Any]:
    from twin.kernels import friction

    return friction.smoothed_coulomb, friction.no_state


LAW = FrictionLaw(
    name="smoothed-coulomb",
    title="smoothed Coulomb",
    source=Source("assumed"),
    parameters=_PARAMETERS,
    state=(),
    pack=functools.partial(packed, _PARAMETERS),
    load=_load,
)
