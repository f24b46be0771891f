"""A run's motion and pull as measured: what drives the causes' own states up to where a window starts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stand.setup import System
from twin.causes._kind import Undo
from twin.diagnosis.run import Run

Float = NDArray[np.float64]
#: a force below so many sigmas of its noise is none: a slack fibre's noise would pull on average
SLACK = 6.0


def measured_path(run: Run, ends: Float, share: float, undo: Undo, n: int) -> tuple[Float, Float]:
    """u, v, s, w [n, 4] of a run's first samples, the rim balanced between the strands, and the drive strand's pull,
    N [n], -1 where none was measured.

    ends: x and x' at the fibre's end [n, 2]; share: c1/(c1 + c2); undo: how the gauge's true force is had.
    """
    u, v = run.u.value[:n], run.u.rate[:n]
    if run.setup.system is not System.WFPD:
        return np.ascontiguousarray(np.column_stack([u, v, np.zeros((n, 2))])), np.full(n, -1.0)
    s, w = (share * a + (1 - share) * b for a, b in ((u, ends[:, 0]), (v, ends[:, 1])))
    time, all_time = np.arange(n) * run.dt, np.arange(len(run.F.value)) * run.dt
    at = time + undo.F_late + undo.F_drift * time
    F, rate = (np.interp(at, all_time, a) for a in (run.F.value, run.F.rate))
    told = F + undo.F_lag * rate - undo.F_offset - undo.F_rate * time
    told = (told - undo.F_mass * np.gradient(ends[:, 1], run.dt)) / undo.F_gain
    told = np.where(told * undo.F_gain > SLACK * run.noise_F, told, 0.0)
    return np.ascontiguousarray(np.column_stack([u, v, s, w])), np.where(run.bad[:n, 1], -1.0, told)
