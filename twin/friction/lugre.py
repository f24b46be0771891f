"""LuGre friction: the mean deflection of bristles is an inner state."""

from __future__ import annotations

import functools
from typing import Any

from twin.friction import FrictionLaw, packed
from twin.parameter import Parameter, Source

_PARAMETERS = (
    Parameter("bristle_stiffness", "N/m", 1e5, (1.0, 1e9), None, "sigma_0"),
    Parameter("bristle_damping", "N*s/m", 316.22776601683796, (0.0, 1e6), None, "sigma_1"),
    Parameter("viscous", "N*s/m", 0.4, (0.0, 1e4), None, "sigma_2"),
    Parameter("coulomb", "N", 1.0, (1e-9, 1e4), None, "F_c"),
    Parameter("static", "N", 1.5, (1e-9, 1e4), None, "F_s"),
    Parameter("stribeck_velocity", "m/s", 1e-3, (1e-9, 10.0), None, "v_s"),
)


def _load() -> tuple[Any, Any]:
    from twin.kernels import friction

    return friction.lugre, friction.lugre_rate


LAW = FrictionLaw(
    name="lugre",
    title="LuGre",
    source=Source("Canudas de Wit, Olsson, Astrom, Lischinsky", 1995, "eqs. 1 to 4"),
    parameters=_PARAMETERS,
    state=("deflection [m]",),
    pack=functools.partial(packed, _PARAMETERS),
    load=_load,
)
