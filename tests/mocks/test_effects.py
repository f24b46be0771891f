"""Every hidden effect does what its definition says, where it says, and nothing at its null."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest

from mocks import effects
from mocks.plant.motion import Motion, targets
from mocks.plant.plant import GRID, Plant, Slice
from mocks.plant.rig import Rig

CATALOGUE = [
    "fibre-stiffness",
    "fibre-damping",
    "velocity-dependent-damping",
    "velocity-dependent-stiffness",
    "fibre-hardening",
    "fibre-viscoelasticity",
    "fibre-hysteresis",
    "fibre-creep",
    "fibre-mass",
    "pulley-inertia",
    "pulley-bearing-friction",
    "pulley-bearing-drag",
    "pulley-eccentricity",
    "fibre-pulley-slip",
    "guide-coulomb-friction",
    "guide-stribeck-friction",
    "guide-friction-asymmetry",
    "guide-rough-patch",
    "guide-viscous-drag",
    "guide-quadratic-drag",
    "end-stop",
    "weight-mass",
    "incline-angle",
    "dial-gauge-spring",
    "drive-backlash",
    "drive-compliance",
    "drive-delay",
    "drive-scale",
    "dial-gauge-lag",
    "dial-gauge-delay",
    "dial-gauge-scale",
    "dial-gauge-saturation",
    "dial-gauge-sticking",
    "force-gauge-lag",
    "force-gauge-delay",
    "force-gauge-scale",
    "force-gauge-offset",
    "force-gauge-drift",
    "force-gauge-saturation",
    "force-gauge-resonance",
    "force-gauge-inertia",
    "mains-hum",
    "clock-drift",
]
SENSORS = ("dial-gauge", "force-gauge", "wiring")
U, V, S, W, F, T1, T2, FRICTION = 2, 3, 4, 5, 6, 7, 8, 9
STRONG = Motion("trapezoidal", 1.5, 0.058, 0.20)
TAUT = Motion("trapezoidal", 1.0, 0.040, 0.35)
X = 0
HELD = Rig(weight_mass=3.096e9, gravity=9.81e-9)  # as heavy as ever, and not to be moved


def path_of(motion: Motion) -> np.ndarray:
    """One cycle with 0.2 s of rest before and after."""
    cut = round(0.8 / GRID)
    return targets(motion, 2.0 + 1.0 / motion.frequency, GRID)[cut:-cut]


def at(seconds: float) -> int:
    """Grid index of a time after the motion's begin."""
    return round((0.2 + seconds) / GRID)


@functools.cache
def run(motion: Motion, name: str = "", null: bool = False, **values: float) -> Slice:
    hidden = {name: (effects.find(name).null() if null else values)} if name else {}
    return Plant(Rig(), hidden).follow(path_of(motion))


def taut(name: str, **values: float) -> Slice:
    return run(TAUT, name, **values)


def largest(name: str, channel: str, motion: Motion = STRONG) -> float:
    """The largest change of a channel by an effect of default size."""
    return float(np.abs(getattr(run(motion, name), channel) - getattr(run(motion), channel)).max())


def test_the_catalogue_is_complete() -> None:
    found = {effect.name for effect in effects.everything() if effect.catalogued}
    assert found == set(CATALOGUE)


def test_at_least_eight_are_in_no_catalogue_and_say_on_what_they_depend() -> None:
    outside = [effect for effect in effects.everything() if not effect.catalogued]
    known = {"time", "frequency", "weight_position", "weight_velocity", "drive_position", "fibre_force", "pulley_angle"}
    assert len(outside) >= 8
    assert all(set(effect.depends_on) <= known for effect in outside)


@pytest.mark.parametrize("name", effects.names())
def test_it_changes_what_is_recorded_and_nothing_at_its_null(name: str) -> None:
    plain, nothing = run(STRONG), run(STRONG, name, null=True)
    for channel in ("x", "u", "F"):
        assert np.array_equal(getattr(nothing, channel), getattr(plain, channel)), channel
    hidden = run(STRONG, name)
    assert np.isfinite(hidden.truth).all()
    clocks = Plant(hidden={name: {}}).world.clocks
    assert clocks or max(largest(name, "u") / 6e-6, largest(name, "F") / 0.12) > 1.0


@pytest.mark.parametrize("name", effects.names())
def test_sensors_do_not_touch_the_motion_and_the_rest_does(name: str) -> None:
    hidden, plain = run(STRONG, name), run(STRONG)
    if name == "clock-drift":
        return
    same = np.array_equal(hidden.truth, plain.truth)
    assert same == (effects.find(name).acts_on in SENSORS)


@pytest.mark.parametrize("name", effects.names())
def test_its_parameters_say_what_they_are(name: str) -> None:
    effect = effects.find(name)
    for size in effect.sizes:
        assert size.choices or size.steady or size.low < size.high
        assert size.default in size.choices if size.choices else size.low <= float(size.default) <= size.high
    assert any(not size.steady and not size.choices for size in effect.sizes)


def test_the_weight_rests_where_it_did_whatever_is_hidden() -> None:
    """All zeros are those of the rest state: before the drive moves nothing else does."""
    for effect in effects.everything():
        if effect.name in ("base-vibration", "mains-hum", "force-gauge-drift"):
            continue
        rest = run(STRONG, effect.name).u[: at(-0.05)]
        assert np.abs(rest).max() < 1e-9, effect.name


def test_guide_forces_follow_their_definitions() -> None:
    for name, law in {
        "guide-viscous-drag": lambda v: 8.0 * v,
        "guide-quadratic-drag": lambda v: 15.0 * v * abs(v),
        "guide-stribeck-friction": lambda v: 4.0 * np.exp(-((v / 0.03) ** 2)) * np.sign(v),
        "guide-friction-asymmetry": lambda v: 0.75 * np.ones_like(v),
        "guide-coulomb-friction": lambda v: 2.0 * np.sign(v),
    }.items():
        truth = taut(name).truth
        v, fast = truth[:, V], np.abs(truth[:, V]) > 0.02
        assert np.allclose((truth[:, FRICTION] - 3.0 * np.sign(v))[fast], law(v)[fast], atol=1e-3), name


def test_the_rough_patch_is_where_it_is_said_to_be() -> None:
    truth = taut("guide-rough-patch").truth
    u, moving = truth[:, U], np.abs(truth[:, V]) > 0.02
    extra = np.abs(truth[:, FRICTION]) - 3.0
    assert np.allclose(extra[moving & (np.abs(u - 0.018) < 0.003)], 4.0, atol=0.05)
    assert np.abs(extra[moving & (np.abs(u - 0.018) > 0.008)]).max() < 0.05


def test_the_end_stop_stops() -> None:
    assert run(TAUT, "end-stop").u.max() == pytest.approx(0.024, abs=5e-3)
    assert run(TAUT).u.max() > 0.039


def test_the_plungers_spring_shows_at_the_holds() -> None:
    held = slice(at(0.42), at(0.48))
    more = (taut("dial-gauge-spring").F - run(TAUT).F)[held].mean()
    assert more == pytest.approx(80.0 * 0.040, rel=0.05)


def test_fibre_causes_change_the_tension_as_defined() -> None:
    rig = Rig()
    share1 = rig.free_length / rig.weight_strand_length
    rest = rig.rest_tension
    truth = taut("fibre-hardening", coefficient=150.0).truth
    d = truth[:, S] - truth[:, U]
    whole = d * share1 + (math.sqrt(1 + 4 * 150.0 * rest / rig.fibre_stiffness) - 1) / 300.0
    expected = rig.fibre_stiffness * whole * (1 + 150.0 * whole) + 27.5 * share1 * (truth[:, W] - truth[:, V])
    assert np.allclose(truth[:, T1], expected, atol=1e-6)
    truth = run(STRONG, "velocity-dependent-damping").truth
    stretched = truth[:, S] - truth[:, U] + rest / (share1 * rig.fibre_stiffness)
    b = (27.5 + 385.0 * np.maximum(0.0, np.abs(truth[:, V]) - 0.4)) * share1
    expected = rig.fibre_stiffness * share1 * stretched + b * (truth[:, W] - truth[:, V])
    assert np.allclose(truth[:, T1], np.where(stretched > 0, np.maximum(expected, 0), 0), atol=1e-6)


def test_creep_and_viscoelasticity_relax_and_hysteresis_does_not() -> None:
    """After a pull that lasts, by how much the force at the gauge still changes (drive and weight held)."""

    def held_force(name: str, **values: float) -> np.ndarray:
        plant = Plant(HELD, {name: values})
        plant.advance(400, 2e-4, 0.0)
        return plant.advance(80000, 2e-4, 0.0).F

    creeping = held_force("fibre-creep", compliance=4e-6, time_constant=0.6)
    relaxing = held_force("fibre-viscoelasticity", stiffness=6000.0, time_constant=0.05)
    hysteretic = held_force("fibre-hysteresis", stiffness=5000.0, yield_elongation=3e-4)
    k = Rig().fibre_stiffness
    assert relaxing[200] - relaxing[-1] > 0.3
    assert relaxing[-1] == pytest.approx(15.19 + k * 2e-4, abs=0.05)
    assert creeping[-1] - 15.19 == pytest.approx(2e-4 / (1 / k + 4e-6), rel=0.01)
    assert abs(hysteretic[4000] - hysteretic[-1]) < 0.02
    assert hysteretic[-1] > 15.19 + k * 2e-4 + 0.2


def test_pulley_causes_act_at_the_rim() -> None:
    rig = Rig()
    for name, law in {
        "pulley-bearing-drag": lambda r: 5.0 * r[:, W],
        "pulley-bearing-friction": lambda r: 0.02 * (r[:, T1] + r[:, T2]) * np.sign(r[:, W]),
    }.items():
        truth = taut(name).truth
        inertia = rig.pulley_inertia / rig.pulley_radius**2 * np.gradient(truth[:, W], GRID)
        lost = truth[:, T2] - truth[:, T1] - inertia
        turning = np.abs(truth[:, W]) > 0.03
        assert np.median(np.abs(lost - law(truth))[turning]) < 0.01, name


def test_bearing_friction_stays_at_a_hold() -> None:
    truth = taut("pulley-bearing-friction").truth[at(0.45)]
    assert abs(truth[T2] - truth[T1]) > 0.02


def test_the_fibre_slides_at_eulers_ratio_and_not_before() -> None:
    truth = run(STRONG, "fibre-pulley-slip", friction=0.05).truth
    pulling = (truth[:, T1] > 1.0) & (truth[:, T2] > 1.0)
    ratio = np.maximum(truth[:, T1] / truth[:, T2].clip(1e-9), truth[:, T2] / truth[:, T1].clip(1e-9))[pulling]
    limit = math.exp(0.05 * Rig().wrap_angle)
    assert ratio.max() == pytest.approx(limit, rel=1e-3)
    assert np.array_equal(run(TAUT, "fibre-pulley-slip", friction=0.5).u, run(TAUT).u)


def test_drive_causes_stand_between_the_encoder_and_the_fibre() -> None:
    plain = run(TAUT)
    for name in ("drive-backlash", "drive-compliance", "drive-delay", "drive-scale", "drive-pitch-error"):
        assert np.array_equal(taut(name).x, plain.x), name
    assert np.allclose(taut("drive-scale").truth[:, X], 1.01 * plain.x)
    late = taut("drive-delay").truth[:, X]
    assert np.allclose(late[40:], plain.x[:-40], atol=1e-9)
    gap = plain.x - taut("drive-backlash").truth[:, X]
    assert gap.max() == pytest.approx(1e-4, rel=1e-6)
    assert gap.min() == pytest.approx(-1e-4, rel=1e-6)


def test_a_soft_mount_adds_its_compliance_to_the_fibre() -> None:
    plant = Plant(HELD, {"drive-compliance": {"compliance": 4e-6}})
    force = plant.advance(20000, 2e-4, 0.0).F[-1]
    assert force - 15.19 == pytest.approx(2e-4 / (1 / 34e3 + 4e-6), rel=0.01)


def test_gauge_causes_follow_their_definitions() -> None:
    plain = run(STRONG)
    n = 40  # 2 ms
    assert np.allclose(run(STRONG, "dial-gauge-delay").u[n:], plain.u[:-n], atol=1e-12)
    assert np.allclose(run(STRONG, "force-gauge-delay").F[n:], plain.F[:-n], atol=1e-9)
    assert np.allclose(run(STRONG, "dial-gauge-scale").u, 1.01 * plain.u)
    assert np.allclose(run(STRONG, "force-gauge-scale").F, 1.06 * plain.F)
    assert np.allclose(run(STRONG, "force-gauge-offset").F, plain.F + 2.0)
    assert np.allclose(run(STRONG, "force-gauge-drift").F, plain.F + 0.5 * plain.time)
    assert run(STRONG, "force-gauge-saturation").F.max() == 30.0
    assert run(STRONG, "dial-gauge-saturation").u.max() == 0.026
    for name, tau, signal in (("dial-gauge-lag", 3e-3, "u"), ("force-gauge-lag", 3e-3, "F")):
        slow = getattr(run(STRONG, name), signal)
        rate = (slow[2:] - slow[:-2]) / (2 * GRID)
        assert np.median(np.abs(slow[1:-1] + tau * rate - getattr(plain, signal)[1:-1])) < 1e-3, name
    held = slice(0, at(-0.05))
    assert np.allclose(run(STRONG, "force-gauge-resonance").F[held], plain.F[held], atol=1e-9)


def test_the_gauges_own_mass_pulls_with_the_drive() -> None:
    plain, hidden = run(TAUT), run(TAUT, "force-gauge-inertia")
    acceleration = np.gradient(plain.truth[:, 1], GRID)
    assert np.allclose(hidden.F - plain.F, 0.4 * acceleration, atol=0.02)


def test_hum_goes_where_it_is_told() -> None:
    plain = run(TAUT)
    hidden = Plant(hidden={"mains-hum": {"signal": "weight_position", "amplitude": 5e-5}})
    heard = hidden.follow(path_of(TAUT)).u - plain.u
    assert np.ptp(heard) == pytest.approx(1e-4, rel=1e-3)
    assert np.sqrt(2.0) * heard[:4000].std() == pytest.approx(5e-5, rel=1e-2)


def test_the_fibres_mass_needs_force_to_be_moved() -> None:
    run_heavy = taut("fibre-mass", mass=0.1).truth
    plain = run(TAUT).truth
    assert 0.05 < np.abs(run_heavy[:, F] - plain[:, F]).max() < 2.0
