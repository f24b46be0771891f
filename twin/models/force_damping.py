"""Force model with velocity-dependent damping: b, and b + (|u'| - v_tr) b_2 above the threshold (S1 eq. 1)."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from stand.setup import Setup, System
from twin.kernels import force_plugin
from twin.model import FibreModel
from twin.parameter import Parameter, Source

THRESHOLD = Parameter("threshold", "m/s", 0.4, (0.0, math.inf), 0.05, "speed of the weight above which damping grows")
SLOPE = Parameter("damping_slope", "N*s^2/m^2", 385.0, (0.0, math.inf), 100.0, "growth of damping with speed")
SIGNED = Parameter("signed", "1", 0.0, (0.0, 1.0), None, "1: the threshold is on u' as S1 prints it, not on |u'|")
_PARAMETERS = (THRESHOLD, SLOPE, SIGNED)


def _constants(setup: Setup, parameters: Mapping[str, float]) -> NDArray[np.float64]:
    return force_plugin.constants(setup, {p.name: p.value for p in _PARAMETERS} | dict(parameters))


MODEL = FibreModel(
    name="force-damping",
    title="Force model, velocity-dependent damping b(v)",
    source=Source("Polach, Hajzman, Dupal", 2020, "eq. 1"),
    systems=frozenset({System.WFPD, System.WF}),
    parameters=_PARAMETERS,
    state=force_plugin.NAMES,
    constants=_constants,
    start=force_plugin.start,
    advance=force_plugin.advance,
    warm=force_plugin.warm,
)
