"""The force models against the physics that any model must give, and against a tight reference."""

from __future__ import annotations

import math

import numpy as np
import pytest

import twin.models
from stand.setup import Setup, System, nominal
from tests.twin.reference import Reference, sinusoid, trapezoid
from twin.kernels.hermite import drive_table
from twin.model import FibreModel, Start
from twin.plugins import load
from twin.simulate import run_table

DT = 5e-4
FORCE = load(twin.models, "force", FibreModel)
DAMPING = load(twin.models, "force-damping", FibreModel)
STIFFNESS = load(twin.models, "force-stiffness", FibreModel)
BOTH = load(twin.models, "force-both", FibreModel)
FREE = nominal().with_values(guide_friction=0.0, fibre_damping=0.0)


def run(setup: Setup, table: np.ndarray, model: FibreModel = FORCE, start: Start | None = None, **parameters: float):
    """u, u', F [n, 3] at every sample, from rest where no start is given."""
    return run_table(model, model.constants(setup, parameters), start or Start(), table, DT)[1]


def held(seconds: float) -> np.ndarray:
    return np.zeros((round(seconds / DT) + 1, 2))


def frequency(u: np.ndarray) -> float:
    """Hz, from the upward zero crossings of a sampled sine."""
    up = np.flatnonzero((u[:-1] < 0) & (u[1:] >= 0))
    at = up - u[up] / (u[up + 1] - u[up])
    return (len(at) - 1) / ((at[-1] - at[0]) * DT)


def modes(setup: Setup) -> float:
    """The lowest frequency in Hz of weight and pulley on their two strands, drive held."""
    c, length = setup.fibre_stiffness, setup.free_length
    c1, c2 = c * length / setup.weight_strand_length, c * length / setup.drive_strand_length
    mu = setup.pulley_inertia / setup.pulley_radius**2
    m = np.array([[c1 / setup.mass, -c1 / setup.mass], [-c1 / mu, (c1 + c2) / mu]])
    return math.sqrt(min(np.linalg.eigvals(m).real)) / (2 * math.pi)


@pytest.mark.parametrize(("added", "expected"), [(0.0, 16.68), (5.035, 10.29)])
def test_a_pulley_without_mass_gives_the_free_frequency(added: float, expected: float) -> None:
    setup = FREE.with_values(pulley_inertia=0.0, added_mass=added)
    found = frequency(run(setup, held(3.0), start=Start(u=1e-4))[:, 0])
    assert found == pytest.approx(math.sqrt(34e3 / setup.mass) / (2 * math.pi), rel=1e-5)
    assert found == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("added", [0.0, 5.035])
def test_the_pulleys_inertia_lowers_it_as_the_eigenvalues_say(added: float) -> None:
    setup = FREE.with_values(added_mass=added)
    balanced = Start(u=1e-4, s=0.0, rim_speed=0.0)
    spectrum = frequency(run(setup.with_values(fibre_damping=0.3), held(3.0), start=balanced)[1000:, 0])
    assert spectrum == pytest.approx(modes(setup), rel=1e-3)
    assert spectrum < math.sqrt(34e3 / setup.mass) / (2 * math.pi)


@pytest.mark.parametrize(("added", "expected"), [(0.0, 24.71), (5.035, 15.25)])
def test_a_pulley_too_heavy_to_turn_gives_the_locked_frequency(added: float, expected: float) -> None:
    setup = FREE.with_values(pulley_inertia=1e3, added_mass=added)
    start = Start(u=1e-4, s=0.0, rim_speed=0.0)
    assert frequency(run(setup, held(2.0), start=start)[:, 0]) == pytest.approx(expected, rel=1e-3)


def test_the_weight_on_a_fixed_fibre_swings_at_the_published_frequency_and_damping() -> None:
    setup = nominal(System.WF).with_values(guide_friction=0.0)
    u = run(setup, held(0.6), start=Start(u=1e-5))[:, 0]
    top = np.flatnonzero((u[1:-1] > u[:-2]) & (u[1:-1] > u[2:])) + 1
    decrement = math.log(u[top[0]] / u[top[3]]) / 3
    zeta = decrement / math.hypot(2 * math.pi, decrement)
    assert frequency(u) / math.sqrt(1 - zeta**2) == pytest.approx(29.17, rel=1e-3)
    assert zeta == pytest.approx(0.0736, rel=5e-3)


@pytest.mark.parametrize(("added", "force", "stretch"), [(0.0, 15.19, 0.447e-3), (5.035, 39.88, 1.173e-3)])
def test_the_weight_at_rest_pulls_with_its_share_and_stretches_the_fibre(
    added: float, force: float, stretch: float
) -> None:
    out = run(nominal().with_values(added_mass=added), held(0.5))
    assert out[-1, 2] == pytest.approx(force, abs=0.006)
    assert abs(out[:, 0]).max() < 1e-12
    assert out[-1, 2] / 34e3 == pytest.approx(stretch, rel=2e-3)


@pytest.mark.parametrize(("added", "onset"), [(0.0, 3.9), (5.035, 4.5)])
def test_the_fibre_goes_slack_where_the_drive_falls_faster_than_the_weight_can(added: float, onset: float) -> None:
    setup = nominal().with_values(added_mass=added)

    def slack(acceleration: float) -> bool:
        time = np.arange(3000) * DT
        a = acceleration * (1.0 - np.exp(-((time / 0.4) ** 2)))
        v = -np.cumsum(a) * DT
        x = np.cumsum(v) * DT
        return bool(run(setup, drive_table(x, DT))[:, 2].min() == 0.0)

    assert not slack(onset - 0.15)
    assert slack(onset + 0.15)


@pytest.mark.parametrize("name", ["force-damping", "force-both"])
def test_below_the_threshold_speed_velocity_dependence_changes_no_bit(name: str) -> None:
    table = sinusoid(6.0, 0.09, 0.35)
    assert np.array_equal(run(nominal(), table), run(nominal(), table, load(twin.models, name, FibreModel)))


def test_above_it_damping_and_stiffness_change_the_motion_each_in_its_own_way() -> None:
    table = trapezoid(2.0, 0.02, 2.0, 6.0)
    motions = [run(nominal(), table, model)[:, 0] for model in (FORCE, DAMPING, STIFFNESS, BOTH)]
    for i, a in enumerate(motions):
        assert all(np.abs(a - b).max() > 1e-4 for b in motions[:i])


def test_the_signed_threshold_acts_only_on_the_way_up() -> None:
    table = trapezoid(2.0, 0.02, 2.0, 6.0)
    both_ways, upward = run(nominal(), table, DAMPING), run(nominal(), table, DAMPING, signed=1.0)
    split = int(np.flatnonzero(np.any(both_ways != upward, axis=1))[0])
    assert upward[split, 1] < -0.39
    faster = np.flatnonzero(upward[:, 1] > 0.4)
    assert faster[0] < split


def test_a_taut_motion_agrees_with_a_tight_reference() -> None:
    table = sinusoid(0.8, 0.09, 0.7)
    expected = Reference(nominal()).run(table)
    assert np.abs(run(nominal(), table)[1:, 0] - expected[:, 0]).max() < 1e-8 * np.ptp(expected[:, 0])


def test_slack_and_snatch_agree_with_a_tight_reference() -> None:
    table = trapezoid(1.6, 0.02, 2.0, 6.0)
    expected = Reference(nominal()).run(table)
    assert (expected[:, 2] == 0).mean() > 0.2
    out = run(nominal(), table)[1:]
    assert np.abs(out[:, 0] - expected[:, 0]).max() < 1e-8 * np.ptp(expected[:, 0])
    assert np.abs(out[:, 2] - expected[:, 2]).max() < 1e-5


def test_velocity_dependent_damping_agrees_with_a_tight_reference() -> None:
    table = trapezoid(1.0, 0.02, 2.0, 6.0)
    expected = Reference(nominal(), threshold=0.3, damping_slope=385.0).run(table)
    assert np.abs(expected[:, 1]).max() > 0.35
    out = run(nominal(), table, DAMPING, threshold=0.3)[1:]
    assert np.abs(out[:, 0] - expected[:, 0]).max() < 1e-7 * np.ptp(expected[:, 0])


@pytest.mark.parametrize("model", [FORCE, BOTH], ids=lambda model: model.name)
@pytest.mark.parametrize("inertia", [0.0, 2e-4])
def test_a_run_split_anywhere_gives_the_same_bits(model: FibreModel, inertia: float) -> None:
    setup, table = nominal().with_values(pulley_inertia=inertia), trapezoid(2.0, 0.02, 2.0, 6.0)
    whole, k = run(setup, table, model), model.constants(setup, {})
    state, parts = model.start(k, Start()), [whole[:1]]
    for begin in range(0, len(table) - 1, 37):
        part = table[begin : begin + 38]
        out = np.empty((len(part) - 1, 3))
        assert model.advance(k, state, part, DT, out) == 0
        parts.append(out)
    assert np.array_equal(np.vstack(parts), whole)


def test_a_pulley_of_vanishing_mass_moves_as_one_without_mass() -> None:
    table = trapezoid(0.9, 0.02, 2.0, 6.0)
    without = run(nominal().with_values(pulley_inertia=0.0), table)
    light = run(nominal().with_values(pulley_inertia=1e-7), table)
    assert np.abs(without[:, 0] - light[:, 0]).max() < 2e-3 * np.ptp(without[:, 0])


def test_without_losses_the_energy_of_a_bouncing_weight_is_kept() -> None:
    setup = nominal(System.WF).with_values(guide_friction=0.0, fibre_damping=0.0)
    out = run(setup, held(5.0), start=Start(u=0.01))
    stretch = np.maximum(0.0, setup.rest_tension / setup.fibre_stiffness - out[:, 0])
    energy = 0.5 * setup.mass * out[:, 1] ** 2 + setup.rest_tension * out[:, 0] + 0.5 * 104e3 * stretch**2
    assert (out[:, 2] == 0).mean() > 0.3
    assert np.ptp(energy) < 1e-9 * energy.max()


def test_work_put_in_is_stored_or_lost_to_friction_and_damping() -> None:
    setup, table = nominal().with_values(pulley_inertia=0.0), sinusoid(2.0, 0.03, 1.0)
    out = run(setup, table)
    stretch = (out[:, 2] - 0.0) / 34e3
    work = np.trapezoid(out[:, 2] * table[:, 1], dx=DT)
    friction = np.trapezoid(3.0 * np.tanh(out[:, 1] / 0.002) * out[:, 1], dx=DT)
    damping = np.trapezoid(27.5 * (table[:, 1] - out[:, 1]) ** 2, dx=DT)
    stored = 0.5 * setup.mass * out[-1, 1] ** 2 + setup.rest_tension * out[-1, 0]
    stored += 0.5 * 34e3 * (stretch[-1] ** 2 - stretch[0] ** 2)
    assert work == pytest.approx(stored + friction + damping, abs=2e-4 * abs(friction))
