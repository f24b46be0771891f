"""Coulomb friction with true stick in a narrow band of speed (Karnopp)."""

from __future__ import annotations

import functools
from typing import Any

from twin.friction import FrictionLaw, packed
from twin.parameter import Parameter, Source

_PARAMETERS = (
    Parameter("coulomb", "N", 3.0, (0.0, 1e4), None, "dry friction while sliding"),
    Parameter("static", "N", 4.0, (0.0, 1e4), None, "largest friction at rest"),
    Parameter("band", "m/s", 1e-4, (1e-9, 0.1), None, "speed below which the body sticks"),
)


def _load() -> tuple[Any, Any]:
    from twin.kernels import friction

    return friction.coulomb_with_stick, friction.no_state


LAW = FrictionLaw(
    name="coulomb-with-stick",
    title="Coulomb with stick",
    source=Source("Karnopp", 1985, "eq. 3"),
    parameters=_PARAMETERS,
    state=(),
    pack=functools.partial(packed, _PARAMETERS),
    load=_load,
)
