"""Dahl friction: a spring that yields; rate-independent."""

from __future__ import annotations

import functools
from typing import Any

from twin.friction import FrictionLaw, packed
from twin.parameter import Parameter, Source

_PARAMETERS = (
    Parameter("stiffness", "N/m", 1e5, (1.0, 1e9), None, "slope at a reversal"),
    Parameter("coulomb", "N", 3.0, (1e-9, 1e4), None, "friction reached after a long way"),
    Parameter("exponent", "-", 1.0, (0.1, 10.0), None, "shape of the knee"),
)


def _load() -> tuple[Any, Any]:
    from twin.kernels import friction

    return friction.dahl, friction.dahl_rate


LAW = FrictionLaw(
    name="dahl",
    title="Dahl",
    source=Source("Dahl", 1976, "eq. 2"),
    parameters=_PARAMETERS,
    state=("deflection [m]",),
    pack=functools.partial(packed, _PARAMETERS),
    load=_load,
)
