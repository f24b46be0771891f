"""Stribeck friction: falls from the static to the sliding value, then rises with speed."""

from __future__ import annotations

import functools
from typing import Any

from twin.friction import FrictionLaw, packed
from twin.parameter import Parameter, Source

_PARAMETERS = (
    Parameter("coulomb", "N", 3.0, (0.0, 1e4), None, "dry friction while sliding"),
    Parameter("static", "N", 4.0, (0.0, 1e4), None, "friction just above rest"),
    Parameter("stribeck_velocity", "m/s", 0.01, (1e-9, 10.0), None, "speed over which it falls"),
    Parameter("smoothing", "m/s", 0.002, (1e-9, 1.0), None, "speed that smooths the sign"),
    Parameter("viscous", "N*s/m", 0.0, (0.0, 1e4), None, "drag"),
)


def _load() -> tuple[Any, Any]:
    from twin.kernels import friction

    return friction.stribeck, friction.no_state


LAW = FrictionLaw(
    name="stribeck",
    title="Stribeck",
    source=Source("Pust, Pesek, Radolfova", 2011),
    parameters=_PARAMETERS,
    state=(),
    pack=functools.partial(packed, _PARAMETERS),
    load=_load,
)
