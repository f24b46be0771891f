"""The discretised fibres against Exudyn: the same mechanics in both, taut, without friction."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from importlib.util import find_spec

import numpy as np

import twin.models
from bench.force import DT
from bench.models import AMPLITUDE, OMEGA, STEP, Float, run, taut
from bench.row import Row, row
from stand.setup import nominal
from twin.model import FibreModel, Start
from twin.plugins import load

Solve = Callable[[float, float], tuple[Float, float]]
#: agreement of u between the codes, as a share of its range
AGREE = 1e-3
#: Exudyn's cables: spectral radius, whether Newton's method is modified, step; those that come out fast or agree
SETTINGS = ((0.5, True, STEP), (0.5, True, STEP / 2), (0.7, True, 5e-4), (0.7, True, STEP), (0.9, False, 5e-4))


def _missing(job: str) -> Row:
    return row(job, "exudyn", None, None, "exudyn is not installed: `make bench` brings it")


def _off(data: Float, truth: Float) -> float:
    grid = np.arange(1, len(truth) + 1) * DT
    return float(np.abs(np.interp(grid, data[:, 0], data[:, 1]) - truth).max() / np.ptp(truth))


def point_mass() -> Iterator[Row]:
    """The chain of 7 at the default order 2, and at order 4, with Exudyn at the step that gives the same error."""
    if find_spec("exudyn") is None:
        yield _missing("point mass 7, taut")
        return
    from bench.exudyn_chain import solve

    setup, own, seconds = nominal().with_values(guide_friction=0.0), {"pulley_friction": 0.0}, 2.0
    drive, model = taut(seconds), load(twin.models, "point-mass", FibreModel)
    fine = run("point-mass", setup, drive, {**own, "order": 4, "step": DT / 8}, 1)[0][:, 0]
    c = model.constants(setup, own)
    nodes = model.start(c, Start())[2:16].reshape(-1, 2)
    # the codes agree to some 4e-8 at rest: order 4 is compared at 1e-7, though its own error is far below
    for order, goal, steps in ((4, 1e-7, (64, 32, 16, 8)), (2, 0.0, (250, 125, 64))):
        ours, computing = run("point-mass", setup, drive, {**own, "order": order})
        mine = float(np.abs(ours[:, 0] - fine).max() / np.ptp(fine))
        theirs, found, step = math.inf, math.inf, 0.0
        for micro in steps:
            data, theirs = solve(c, nodes, AMPLITUDE, OMEGA, seconds, micro * 1e-6)
            found, step = _off(data, fine), micro
            if found <= max(mine, goal):
                break
        note = f"ours {seconds / computing:.0f}x real time; exudyn {found:.1e} at {step} us, {seconds / theirs:.2g}x"
        yield row(f"point mass 7, taut, order {order}", "exudyn", theirs / computing, mine, note)


def ancf() -> Iterator[Row]:
    """18 elements on one contact law (pressure over depth): both at 250 us, and both at their fastest that agrees."""
    if find_spec("exudyn") is None:
        yield _missing("ANCF 18 at 250 us, taut")
        return
    from bench.exudyn_cable import solve

    setup, own, seconds = nominal().with_values(guide_friction=0.0), {"pulley_friction": 0.0}, 0.4
    drive, model = taut(seconds), load(twin.models, "ancf", FibreModel)
    fine = run("ancf", setup, drive, {**own, "step": DT / 16}, 1)[0][:, 0]
    c = model.constants(setup, own)
    state, tried = model.start(c, Start()), []
    for radius, modified, step in SETTINGS:
        data, theirs = solve(c, state, AMPLITUDE, OMEGA, seconds, step, radius, modified)
        kind = "modified" if modified else "full"
        label = f"{1e6 * step:.0f} us, spectral radius {radius}, {kind} Newton"
        tried.append((theirs, _off(data, fine), step, label))
    for job, step in (("ANCF 18 at 250 us, taut", STEP), ("ANCF 18 at its fastest, taut", DT)):
        ours, computing = run("ancf", setup, drive, {**own, "step": step})
        mine = float(np.abs(ours[:, 0] - fine).max() / np.ptp(fine))
        agreed = [found for found in tried if found[1] <= AGREE and found[2] <= step]
        theirs, off, _, label = min(agreed, default=(math.inf, math.inf, 0.0, "none"))
        note = f"ours {seconds / computing:.1f}x real time; exudyn {seconds / theirs:.2g}x at {label}"
        note += f", u agrees to {off:.1e}"
        yield row(job, "exudyn", theirs / computing, mine, note)
