"""Problems whose truth is known: a simulated stand whose operator has every value right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from mocks.plant.motion import Motion
from mocks.plant.operator import draw_stand
from mocks.record import Hidden, record
from stand.recording import read_recording
from twin.diagnosis.audit import audit_all
from twin.diagnosis.problem import Problem
from twin.diagnosis.run import choose, prepare

#: a slow run, in which a state may not drift, and one that throws the weight and catches it
SLOW, THROWN = Motion("trapezoidal", 0.25, 0.04, 0.8), Motion("rectangular", 1.0, 0.05, 0.0)


def exact(folder: Path, hidden: Hidden, motions: Sequence[Motion], *, windows: int = 24, seed: int = 62) -> Problem:
    """Runs of 8 s, a seed each, with `windows` of each."""
    stand = draw_stand(62)
    stand = replace(stand, true=stand.believed)
    paths = [
        record(stand, motion, path=folder / f"{i}.h5", seconds=8.0, seed=seed + i, hidden=hidden)
        for i, motion in enumerate(motions)
    ]
    runs = tuple(prepare(r) for r in audit_all([read_recording(p) for p in paths], ())[0])
    return Problem(runs, choose(runs, windows))
