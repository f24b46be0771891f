"""The simulated stand obeys what the physics must give."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mocks.battery.draw import battery
from mocks.plant import march
from mocks.plant.motion import Motion, targets
from mocks.plant.plant import GRID, Plant, Slice
from mocks.plant.rig import Rig

ADDED = 5.035
COLUMN = {name: i for i, name in enumerate(march.COLUMNS)}
FREE = Rig(guide_friction=0.0, fibre_damping=2.0)


def column(run: Slice, name: str) -> np.ndarray:
    return run.truth[:, COLUMN[name]]


def moved(motion: Motion, seconds: float, rig: Rig | None = None, hidden: dict | None = None) -> Slice:
    return Plant(rig, hidden).follow(targets(motion, seconds, GRID))


def ringing_frequency(rig: Rig) -> float:
    """Frequency of the weight after it was pushed off its rest by 0.1 mm, from its zero crossings."""
    plant = Plant(rig)
    plant._state[0] = -1e-4
    u = plant.carry(np.zeros((20000, 2))).u
    ups = np.flatnonzero((u[:-1] < 0) & (u[1:] >= 0))
    at = ups + u[ups] / (u[ups] - u[ups + 1])
    return float((len(at) - 1) / ((at[-1] - at[0]) * GRID))


@pytest.mark.parametrize(("added", "expected"), [(0.0, 16.68), (ADDED, 10.29)])
def test_the_weight_rings_at_its_frequency_with_a_light_pulley(added: float, expected: float) -> None:
    rig = FREE.but(added_mass=added, pulley_inertia=2e-6)
    assert ringing_frequency(rig) == pytest.approx(expected, abs=0.02)


def test_the_nominal_pulley_makes_it_ring_a_little_slower() -> None:
    assert 16.4 < ringing_frequency(FREE) < 16.67


@pytest.mark.parametrize(("added", "expected"), [(0.0, 24.71), (ADDED, 15.25)])
def test_a_locked_pulley_makes_it_ring_faster(added: float, expected: float) -> None:
    assert ringing_frequency(FREE.but(added_mass=added, pulley_inertia=1e3)) == pytest.approx(expected, abs=0.03)


@pytest.mark.parametrize(("added", "tension", "stretch"), [(0.0, 15.19, 0.447e-3), (ADDED, 39.88, 1.173e-3)])
def test_the_fibre_holds_the_weight_at_rest(added: float, tension: float, stretch: float) -> None:
    plant = Plant(Rig(added_mass=added))
    run = plant.carry(np.zeros((2000, 2)))
    assert np.allclose(run.F, tension, atol=0.01)
    assert np.abs(run.u).max() < 1e-12
    assert plant.world.physics.rest_stretch == pytest.approx(stretch, abs=1e-6)


@pytest.mark.parametrize(("added", "onset"), [(0.0, 3.94), (ADDED, 4.54)])
def test_the_fibre_goes_slack_when_the_drive_falls_faster_than_the_weight_can(added: float, onset: float) -> None:
    def least_tension(acceleration: float) -> float:
        """A drive that sets off downward so gently that nothing rings, with no end stop in its way."""
        time = np.arange(1, 10001) * GRID
        v = -acceleration * np.where(time < 0.4, time**2 / 0.8, time - 0.2)
        plant = Plant(Rig(added_mass=added, pulley_inertia=2e-6))
        plant._record["stop_low"] = -10.0
        return float(plant.carry(np.stack([np.cumsum(v) * GRID, v], axis=-1)).F.min())

    assert least_tension(0.93 * onset) > 0.0
    assert least_tension(1.05 * onset) == 0.0


def test_slow_runs_do_not_know_of_velocity_dependent_damping() -> None:
    slow = Motion("quasi-sinusoidal", 0.35, 0.090)
    plain, hidden = moved(slow, 6.5), moved(slow, 6.5, hidden={"velocity-dependent-damping": {}})
    assert np.array_equal(plain.u, hidden.u)
    assert np.array_equal(plain.F, hidden.F)


def test_snatching_runs_do() -> None:
    strong = Motion("trapezoidal", 1.5, 0.058, 0.20)
    plain, hidden = moved(strong, 3.0), moved(strong, 3.0, hidden={"velocity-dependent-damping": {}})
    assert np.abs(plain.u - hidden.u).max() > 1e-4


def test_energy_is_kept() -> None:
    """What the drive gives is stored, or lost in dampers and friction; nothing comes from nowhere."""
    rig = Rig(fibre_damping=0.0)
    run = moved(Motion("trapezoidal", 1.5, 0.040, 0.20), 3.5, rig)
    v, w, x = column(run, "v"), column(run, "w"), column(run, "drive_speed")
    given = np.cumsum(run.F * x) * GRID
    lost = np.cumsum(column(run, "friction") * v) * GRID
    share1, share2 = rig.free_length / rig.weight_strand_length, rig.free_length / rig.drive_strand_length
    stored = 0.5 * rig.mass * v**2 + rig.rest_tension * run.u + 0.5 * rig.pulley_inertia / 0.04**2 * w**2
    for tension, share in ((column(run, "T1"), share1), (column(run, "T2"), share2)):
        stored = stored + 0.5 * tension**2 / (share * rig.fibre_stiffness)
    balance = given - lost - (stored - stored[0])
    assert np.ptp(given) > 0.3
    assert np.abs(balance).max() < 0.01 * np.ptp(given)


def test_the_drive_follows_smoothly_and_within_its_means() -> None:
    run = moved(Motion("rectangular", 1.0, 0.040), 3.0)
    acceleration = np.diff(column(run, "drive_speed")) / GRID
    assert np.abs(acceleration).max() < 13.5
    assert np.abs(np.diff(acceleration)).max() / GRID < 800.0
    assert run.x.max() == pytest.approx(0.040, abs=2e-4)


def test_slices_of_any_length_give_the_same_run() -> None:
    path = targets(Motion("trapezoidal", 1.5, 0.058, 0.20), 3.0, GRID)
    hidden: dict = {"dial-gauge-lag": {}, "force-gauge-delay": {}, "drive-backlash": {}, "force-gauge-resonance": {}}
    whole, plant = Plant(hidden=hidden).follow(path), Plant(hidden=hidden)
    parts = [plant.follow(path[i : i + 37]) for i in range(0, len(path), 37)]
    for name in ("x", "u", "F"):
        pieces = np.concatenate([getattr(part, name) for part in parts])
        assert np.allclose(getattr(whole, name), pieces, rtol=0.0, atol=1e-9), name


def test_a_target_far_off_is_reached_without_a_jump() -> None:
    plant = Plant()
    run = plant.advance(20000, 0.03, 0.0)
    assert np.abs(np.diff(run.x)).max() / GRID < 0.1
    assert plant.drive[0] == pytest.approx(0.03, abs=1e-4)


def test_added_mass_changes_the_rest_while_the_plant_lives() -> None:
    plant = Plant()
    plant.load(ADDED)
    run = plant.advance(60000, 0.0, 0.0)
    assert run.F[-1] == pytest.approx(39.88, abs=0.02)
    assert run.u[-1] == pytest.approx(-(1.173e-3 - 0.447e-3), abs=3e-6)


def test_a_stand_without_slack_agrees_with_its_linear_equations() -> None:
    """Against the exact solution of the linear free vibration (no friction), over 0.2 s."""
    rig = Rig(guide_friction=0.0)
    plant = Plant(rig)
    plant.carry(np.full((1, 2), [1e-4, 0.0]))
    run = plant.carry(np.full((4000, 2), [1e-4, 0.0]))
    k1 = rig.fibre_stiffness * rig.free_length / rig.weight_strand_length
    k2 = rig.fibre_stiffness * rig.free_length / rig.drive_strand_length
    b1, b2, J = (rig.fibre_damping / rig.fibre_stiffness * k for k in (k1, k2, 0.0))
    J = rig.pulley_inertia / rig.pulley_radius**2
    m = rig.mass
    A = np.array(
        [
            [0, 1, 0, 0],
            [-k1 / m, -b1 / m, k1 / m, b1 / m],
            [0, 0, 0, 1],
            [k1 / J, b1 / J, -(k1 + k2) / J, -(b1 + b2) / J],
        ]
    )
    start = run.truth[0, [COLUMN[c] for c in ("u", "v", "s", "w")]] - np.array([1e-4, 0, 1e-4, 0])
    values, vectors = np.linalg.eig(A)
    weights = np.linalg.solve(vectors, start)
    times = np.arange(len(run.u)) * GRID
    exact = (vectors[0] * weights * np.exp(values * times[:, None])).sum(axis=1).real + 1e-4
    assert np.abs(run.u - exact).max() < 1e-9


def test_a_contact_is_located_whatever_the_step() -> None:
    """Between two snatches a run with a four times finer step agrees to a micrometre."""
    path = targets(Motion("trapezoidal", 1.25, 0.030, 0.20), 2.9, GRID)
    runs = []
    for step in (50e-6, 6.25e-6):
        plant = Plant()
        plant._record["step"] = step
        runs.append(plant.follow(path).u[: round(1.3 / GRID)])
    assert np.abs(runs[0] - runs[1]).max() < 1e-6


def test_ten_seconds_of_plant_take_less_than_they_last() -> None:
    import time

    path = targets(Motion("quasi-sinusoidal", 1.0, 0.03), 10.0, GRID)
    Plant().follow(path[:100])
    begin = time.process_time()
    Plant().follow(path)
    assert time.process_time() - begin < 2.0


def test_hidden_things_that_are_not_there_are_refused_by_name() -> None:
    with pytest.raises(KeyError, match="guide-viscous-drag"):
        Plant(hidden={"no-such-effect": {}})
    with pytest.raises(ValueError, match="coefficient"):
        Plant(hidden={"guide-viscous-drag": {"size": 3.0}})


def test_a_motion_beyond_the_drive_is_refused() -> None:
    with pytest.raises(ValueError, match="jerk"):
        targets(Motion("trapezoidal", 1.0, 0.090, 0.12), 4.0, GRID)
    with pytest.raises(ValueError, match="acceleration"):
        targets(Motion("quasi-sinusoidal", 2.2, 0.14), 6.0, GRID)


def test_motions_are_smooth_and_begin_and_end_with_a_rest() -> None:
    shapes = (("rectangular", 1.0, 0.09, 0.0), ("trapezoidal", 2.0, 0.02, 0.125), ("quasi-sinusoidal", 0.35, 0.09, 0.0))
    for motion in (Motion(*shape) for shape in shapes):
        path = targets(motion, 8.0, GRID)
        assert not path[: round(0.99 / GRID)].any()
        assert np.abs(path[-round(0.95 / GRID) :]).max() < 1e-12
        assert np.abs(np.diff(path[:, 0]) / GRID - 0.5 * (path[1:, 1] + path[:-1, 1])).max() < 1e-4
        assert np.abs(np.diff(path[:, 2])).max() / GRID < 410.0
        assert path[:, 0].max() == pytest.approx(motion.amplitude, abs=1e-9)
        assert math.isclose(motion.cycles(8.0), int(motion.cycles(8.0)))


def test_a_fibre_that_slides_while_it_is_caught_does_not_stop_the_plant() -> None:
    """Its strand closes and opens without end there: found on this stand of the battery."""
    case = battery(20272)[38]
    motion = case.motions[3]
    plant = Plant(case.stand.with_mass(motion.added_mass).believed, case.hidden)
    assert np.isfinite(plant.follow(targets(motion, 7.5, GRID)).F).all()
