"""Force model with velocity-dependent stiffness: c, and c + (|u'| - v_tr) c_2 above the threshold (S1, text)."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from stand.setup import Setup, System
from twin.kernels import force_plugin
from twin.model import FibreModel
from twin.parameter import Parameter, Source

THRESHOLD = Parameter("threshold", "m/s", 0.4, (0.0, math.inf), 0.05, "speed of the weight above which stiffness grows")
SLOPE = Parameter("stiffness_slope", "N*s/m^2", 34e3, (0.0, math.inf), 34e3, "growth of stiffness with speed; assumed")
SIGNED = Parameter("signed", "1", 0.0, (0.0, 1.0), None, "1: the threshold is on u' as S1 prints it, not on |u'|")
_PARAMETERS = (THRESHOLD, SLOPE, SIGNED)


def _constants(setup: Setup, parameters: Mapping[str, float]) -> NDArray[np.float64]:
    return force_plugin.constants(setup, {p.name: p.value for p in _PARAMETERS} | dict(parameters))


MODEL = FibreModel(
    name="force-stiffness",
    title="Force model, velocity-dependent stiffness c(v)",
    source=Source("Polach, Hajzman, Dupal", 2020, "same form as eq. 1; its constant is unpublished"),
    systems=frozenset({System.WFPD, System.WF}),
    parameters=_PARAMETERS,
    state=force_plugin.NAMES,
    constants=_constants,
    start=force_plugin.start,
    advance=force_plugin.advance,
    warm=force_plugin.warm,
)
