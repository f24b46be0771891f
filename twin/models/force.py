"""Force model: two unilateral strands with constant stiffness and damping, a pulley, a weight in a guide."""

from __future__ import annotations

from stand.setup import System
from twin.kernels import force_plugin
from twin.model import FibreModel
from twin.parameter import Source

MODEL = FibreModel(
    name="force",
    title="Force model, constant stiffness and damping",
    source=Source("Polach, Hajzman, Dupal", 2020, "constant c and b"),
    systems=frozenset({System.WFPD, System.WF}),
    parameters=(),
    state=force_plugin.NAMES,
    constants=force_plugin.constants,
    start=force_plugin.start,
    advance=force_plugin.advance,
    warm=force_plugin.warm,
)
