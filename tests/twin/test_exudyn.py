"""The discretised fibres against Exudyn, a multibody code of other people: the same mechanics, taut, no friction."""

import numpy as np
import pytest

import twin.models
from bench.exudyn_rows import AGREE
from bench.force import DT
from bench.models import AMPLITUDE, OMEGA, run, taut
from stand.setup import nominal
from twin.model import FibreModel, Start
from twin.plugins import load

SETUP, OWN = nominal().with_values(guide_friction=0.0), {"pulley_friction": 0.0}


def off(theirs: np.ndarray, ours: np.ndarray) -> float:
    """The largest difference of u as a share of its range."""
    grid = np.arange(1, len(ours) + 1) * DT
    return float(np.abs(np.interp(grid, theirs[:, 0], theirs[:, 1]) - ours).max() / np.ptp(ours))


@pytest.mark.parametrize("order", [2, 4])
def test_seven_point_masses_move_the_weight_as_exudyns_do(order: int) -> None:
    from bench.exudyn_chain import solve

    model, seconds = load(twin.models, "point-mass", FibreModel), 1.0
    ours, _ = run("point-mass", SETUP, taut(seconds), {**OWN, "order": order}, 1)
    c = model.constants(SETUP, OWN)
    nodes = model.start(c, Start())[2:16].reshape(-1, 2)
    assert off(solve(c, nodes, AMPLITUDE, OMEGA, seconds, 64e-6)[0], ours[:, 0]) < AGREE / 100


def test_eighteen_cable_elements_move_the_weight_as_exudyns_do_on_one_contact_law() -> None:
    from bench.exudyn_cable import solve

    model, seconds = load(twin.models, "ancf", FibreModel), 0.4
    ours, _ = run("ancf", SETUP, taut(seconds), OWN, 1)
    c = model.constants(SETUP, OWN)
    state = model.start(c, Start())
    assert off(solve(c, state, AMPLITUDE, OMEGA, seconds, 2.5e-4, 0.7, True)[0], ours[:, 0]) < AGREE
