"""R's ceiling: what even a perfect model could reach, since no start is known better than the sensors say."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from stand.setup import System
from twin.compare.measured import Measured
from twin.model import FibreModel, Start
from twin.score import pearson
from twin.simulate import run_table

Float = NDArray[np.float64]

MEMBERS = 8
#: samples of the parabola from which a speed is known: sigma_v = sigma / (dt sqrt(sum k^2))
SPEED_FIT = 408.0


def last_rest(measured: Measured) -> int:
    """The sample at which the drive begins to move (x' beyond what its noise makes), or where a release begins."""
    if measured.setup.system is not System.WFPD:
        return measured.begin
    speed = np.abs(measured.drive[:, 1])
    rest = speed[: max(8, round(0.4 / measured.dt))]
    moving = np.flatnonzero(speed > max(8.0 * float(np.std(rest)), 2e-3))
    return max(0, int(moving[0]) - round(0.01 / measured.dt)) if len(moving) else 0


def ceilings(measured: Measured, model: FibreModel, constants: Float, seed: int = 1) -> tuple[float, float]:
    """Median R of u and of F between members whose starts differ within the sensors' noise at the end of the rest."""
    at = last_rest(measured)
    rng, drive = np.random.default_rng(seed), np.ascontiguousarray(measured.drive[at:])
    before = _state_at(measured, model, constants, at)
    members = [_member(measured, model, constants, before, drive, rng) for _ in range(MEMBERS)]
    head = np.zeros(at - measured.begin)
    pairs = list(combinations(members, 2))
    R = [[pearson(np.concatenate((head, a[:, c])), np.concatenate((head, b[:, c]))) for a, b in pairs] for c in (0, 2)]
    return float(np.median(R[0])), float(np.median(R[1]))


def _state_at(measured: Measured, model: FibreModel, constants: Float, at: int) -> Start:
    if at == measured.begin:
        return measured.start
    part = np.ascontiguousarray(measured.drive[measured.begin : at + 1])
    state, out = run_table(model, constants, measured.start, part, measured.dt)
    x, w = part[-1]
    rim = (float(state[2]), float(state[3])) if "s" in model.state else (None, None)
    return Start(out[-1, 0], out[-1, 1], float(x), float(w), float(out[-1, 2]), *rim)


def _member(
    measured: Measured, model: FibreModel, constants: Float, at: Start, drive: Float, rng: np.random.Generator
) -> Float:
    sigma_u, sigma_F = measured.noise
    sigma_v = sigma_u / (measured.dt * np.sqrt(SPEED_FIT))
    c2 = measured.setup.fibre_stiffness * measured.setup.free_length / max(measured.setup.drive_strand_length, 1e-9)
    du, dv, ds = rng.standard_normal(3)
    start = Start(
        at.u + sigma_u * du,
        at.v + sigma_v * dv,
        at.x,
        at.w,
        at.force,
        None if at.s is None else at.s + sigma_F / c2 * ds,
        at.rim_speed,
    )
    return run_table(model, constants, start, drive, measured.dt)[1]
