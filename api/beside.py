"""A situation of the papers on the nominal stand: models judged on a stand-in for its recording, beside S1 Table 3."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from api.simulations import simulate
from stand.recording import Recording
from stand.recording.model import F, U

if TYPE_CHECKING:
    from twin.compare import Comparison

#: the model that takes the recording's place: it has what the force models leave out (mass, sag and slip of the fibre)
STAND_IN = "point-mass"
#: one sigma of what both gauges add, m and N
NOISE = (2e-6, 0.02)
REASONS = (
    f"No measured series is published: here the {STAND_IN} model with the gauges' noise stands in for the recording.",
    "S1 publishes no drive history: stroke and ramp are assumed, and the planned motion is followed exactly.",
    "The friction curve in N, the strands' lengths and the pulley's inertia are not published either.",
    "After the first snatch R of a whole run measures chaos as much as the model: read it beside its ceiling.",
)
BELOW = (
    "The weight stays below v_tr here, so constant b and b(v) are one model; S1's two columns contradict its own text."
)


def judged(run: Recording, models: Sequence[str], tell: Callable[[str, float], None]) -> Comparison:
    """`models` over the run's motion, scored against the stand-in with noise (the same at every call)."""
    from twin.compare import compare

    found, _ = simulate(run, STAND_IN)
    rng = np.random.default_rng(1)
    u = found.u + NOISE[0] * rng.standard_normal(len(found.u))
    force = found.F + NOISE[1] * rng.standard_normal(len(found.F))
    return compare(replace(run, channels={**run.channels, U.name: u, F.name: force}), list(models), progress=tell)


def reasons(comparison: Comparison, threshold: float = 0.4) -> list[str]:
    """Why these figures may differ from the published ones; `threshold`: v_tr, m/s."""
    slow = max(float(np.abs(run.v).max()) for run in comparison.runs) < threshold
    return [*REASONS, BELOW] if slow else list(REASONS)


def table_rows(published: dict[str, Any], comparison: Comparison) -> list[list[object]]:
    """Rows channel, then R with constant b and with b(v): as S1 prints them, and as found here (None if not run)."""
    here = {run.name: run for run in comparison.runs}
    rows: list[list[object]] = []
    for channel, score in (("weight_position", "score_u"), ("fibre_force", "score_F")):
        one, two = (published[channel][damping] for damping in ("constant_damping", "velocity_dependent_damping"))
        found = [getattr(here[n], score).R if n in here else None for n in ("force", "force-damping")]
        rows.append([channel, one, two, *found])
    return rows
