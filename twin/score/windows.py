"""Short-window prediction error: restart the model from the measured state every 100 ms and see how far it comes.

After a snatch a free run measures chaos; over a tenth of a second a model is judged by its physics. The state is
reconstructed from u, x and F: speeds by local parabolas, the pulley from F and x, since T2 = F.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.setup import Setup, System
from twin.model import FibreModel, Start
from twin.simulate import run_table

Float = NDArray[np.float64]

#: length of a window and interval of restarts, s
WINDOW = 0.1
#: samples either side of an instant that its local parabola uses
HALF = 8
#: a pulley can be seen only through a taut strand, N
TAUT = 4.0


@dataclass(frozen=True, slots=True)
class WindowError:
    """One restart: its first sample, and the rms of simulated - measured over the window, m and N."""

    first: int
    u: float
    F: float


def parabola(values: Float, dt: float) -> tuple[float, float]:
    """Value and slope in the middle of an odd number of samples, of their least-squares parabola."""
    half = len(values) // 2
    k = np.arange(-half, half + 1.0)
    s2, s4, n = float(np.sum(k**2)), float(np.sum(k**4)), len(values)
    centre = values.mean()
    bend = float((k**2 - s2 / n) @ (values - centre)) / (s4 - s2 * s2 / n)
    return float(centre - bend * s2 / n), float(k @ values) / (s2 * dt)


def reconstruct(setup: Setup, drive: Float, u: Float, F: Float, at: int, dt: float, half: int = HALF) -> Start:
    """The measured state at sample `at` (needs `half` samples on either side).

    drive: [n, 2], x and x'. s = x - (F - tau F')/c2 + T0/c2 with tau = b2/c2, from F = c2 d2 + b2 d2' and T2 = F.
    """
    part = slice(at - half, at + half + 1)
    u0, v0 = parabola(u[part], dt)
    x, w = float(drive[at, 0]), float(drive[at, 1])
    force, rate = parabola(F[part], dt)
    if setup.system is not System.WFPD or force < TAUT:
        return Start(u0, v0, x, w, force=None)
    x0, w0 = parabola(drive[part, 0], dt)
    c2 = setup.fibre_stiffness * setup.free_length / setup.drive_strand_length
    tau = setup.fibre_damping / setup.fibre_stiffness
    stretch = (force - tau * rate - setup.rest_tension) / c2
    return Start(u0, v0, x, w, force=force, s=x0 - stretch, rim_speed=w0 - rate / c2)


def suitable(F: Float, at: int, half: int = HALF) -> bool:
    """True where the fibre is taut and without impact around sample `at`."""
    near = F[at - 2 * half : at + 2 * half + 1]
    return bool(near.min() > TAUT and near.max() < 4.0 * near.min() + 20.0)


def window_error(
    setup: Setup, model: FibreModel, constants: Float, drive: Float, u: Float, F: Float, at: int, dt: float, span: int
) -> WindowError:
    """Restarts `model` at sample `at` and compares the next `span` samples."""
    start = reconstruct(setup, drive, u, F, at, dt)
    _, out = run_table(model, constants, start, np.ascontiguousarray(drive[at : at + span + 1]), dt)
    du, dF = out[1:, 0] - u[at + 1 : at + span + 1], out[1:, 2] - F[at + 1 : at + span + 1]
    return WindowError(at, math.sqrt(float(np.mean(du * du))), math.sqrt(float(np.mean(dF * dF))))


def next_start(F: Float, begin: int, end: int) -> int | None:
    """The first suitable sample in [begin, end), or None: no restart there."""
    for at in range(max(begin, 2 * HALF), end, 4):
        if suitable(F, at):
            return at
    return None


def window_errors(
    setup: Setup, model: FibreModel, constants: Float, drive: Float, u: Float, F: Float, dt: float
) -> tuple[list[WindowError], int]:
    """All restarts of a run, one in each tenth of a second, and how many of these could not be seen into."""
    span, errors, passed = round(WINDOW / dt), [], 0
    for begin in range(0, len(u) - 2 * span, span):
        at = next_start(F, begin, begin + span)
        if at is None:
            passed += 1
        else:
            errors.append(window_error(setup, model, constants, drive, u, F, at, dt, span))
    return errors, passed


def total(errors: list[WindowError]) -> tuple[float, float]:
    """Root mean square over all windows of u's and F's errors, m and N; NaN without a window."""
    if not errors:
        return math.nan, math.nan
    u, F = np.array([e.u for e in errors]), np.array([e.F for e in errors])
    return float(np.sqrt(np.mean(u * u))), float(np.sqrt(np.mean(F * F)))
