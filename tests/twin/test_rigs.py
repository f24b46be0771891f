"""The rigs: their data, the strand's geometry and what the fibre does to the guide."""

from __future__ import annotations

import math

import numpy as np
import pytest

import twin.models
import twin.rigs
from stand.errors import InputError
from stand.setup import check
from tests.twin.fibre_runs import DT, held, pull, run, sine, trapezoid
from twin.model import FibreModel, Start
from twin.plugins import every, load
from twin.rigs import Rig, friction_factor, release, rest_tension, strand

RIGS = [rig.name for rig in every(twin.rigs, Rig)]


def rig(name: str) -> Rig:
    return load(twin.rigs, name, Rig)


@pytest.mark.parametrize("name", RIGS)
def test_every_rig_is_a_stand_that_can_exist(name: str) -> None:
    setup = check(rig(name).setup())
    assert rig(name).excitations
    assert strand(setup).length(0.0) == pytest.approx(setup.weight_strand_length, abs=1e-15)


def test_the_strand_of_a_symmetric_rig_lies_along_the_guide() -> None:
    path = strand(rig("symmetric").setup())
    assert (path.length(0.1), path.cosine(0.1), path.sine(0.1)) == (path.along - 0.1, 1.0, 0.0)


def test_the_asymmetric_strand_shortens_by_its_cosine_and_pulls_sideways() -> None:
    setup = rig("asymmetric").setup()
    path = strand(setup)
    slope = (path.length(0.03 + 1e-6) - path.length(0.03 - 1e-6)) / 2e-6
    assert slope == pytest.approx(-path.cosine(0.03), abs=1e-9)
    assert path.length(0.0) * path.sine(0.0) == pytest.approx(0.280)
    assert rest_tension(setup) * path.cosine(0.0) == pytest.approx(setup.rest_tension)
    assert setup.free_length + setup.pulley_radius * setup.wrap_angle == pytest.approx(1.82)
    assert friction_factor(setup, 0.0, 0.0) == 1.0
    side, normal = 100.0 * path.sine(0.0), setup.mass * setup.gravity * math.cos(setup.incline_angle)
    assert friction_factor(setup, 100.0, 0.0) == pytest.approx(math.sqrt(1 + (side / normal) ** 2))


def test_statics_of_the_published_rigs() -> None:
    light, heavy = rig("symmetric").setup(), rig("symmetric-added-mass").setup()
    assert rest_tension(light) == pytest.approx(15.19, abs=5e-3)
    assert rest_tension(heavy) == pytest.approx(39.88, abs=5e-3)
    assert 1e3 * rest_tension(light) / light.fibre_stiffness == pytest.approx(0.447, abs=5e-4)
    assert 1e3 * rest_tension(heavy) / heavy.fibre_stiffness == pytest.approx(1.173, abs=5e-4)


def test_a_release_needs_the_weight_fibre_rig_and_a_height_it_has() -> None:
    assert release(rig("weight-fibre-45").setup(), 0.02).drop_height == 0.02
    with pytest.raises(InputError, match="out of range"):
        release(rig("weight-fibre-45").setup(), 0.5)
    with pytest.raises(InputError, match="only the weight-fibre rig"):
        release(rig("symmetric").setup(), 0.02)


@pytest.mark.parametrize("name", ["force", "point-mass", "ritz"])
def test_on_the_asymmetric_rig_the_fibre_carries_the_weight_over_its_cosine(name: str) -> None:
    setup = rig("asymmetric").setup().with_values(guide_friction=0.0)
    out = run(name, setup, *held(1.0))
    assert out[-1, 2] == pytest.approx(rest_tension(setup), abs=setup.fibre_mass * setup.gravity)
    assert abs(out[-1, 0]) < 1e-5


def test_on_the_asymmetric_rig_the_force_model_moves_as_the_fibres_with_mass_do() -> None:
    """Ritz leaves the arc out as the force model does; the friction that the sideways pull adds is in both."""
    setup, (x, w) = rig("asymmetric").setup(), sine(1.0, 0.06, 1.0)
    force, ritz, points = (run(name, setup, x, w) for name in ("force", "ritz", "point-mass"))
    assert np.abs(force[:, 0] - ritz[:, 0]).max() < 1e-4 * np.ptp(force[:, 0])
    assert np.abs(force[:, 0] - points[:, 0]).max() < 2e-3 * np.ptp(force[:, 0])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_pulled_steadily_the_asymmetric_guide_rubs_by_what_the_fibre_presses_sideways(sign: float) -> None:
    setup = rig("asymmetric").setup()
    x, w = pull(0.05, 0.05)
    out = run("force", setup, sign * x, sign * w)
    u, tension = float(out[-1, 0]), float(out[-1, 2])
    rubs = tension * strand(setup).cosine(u) - setup.rest_tension
    expected = sign * setup.guide_friction * friction_factor(setup, tension, u)
    assert rubs == pytest.approx(expected, abs=0.01)
    assert abs(expected) > 1.005 * setup.guide_friction


def test_a_vanishing_offset_is_none() -> None:
    """Two integrators of one model: steps of order 4 with located switches, and series with propagators."""
    setup, (x, w) = rig("symmetric").setup(), trapezoid(1.0, 0.02, 2.0, 0.125)
    none, tiny = run("force", setup, x, w), run("force", setup.with_values(lateral_offset=1e-9), x, w)
    assert np.mean(none[:, 2] == 0.0) > 0.1
    assert np.abs(none[:, 0] - tiny[:, 0]).max() < 1e-6 * np.ptp(none[:, 0])


def test_a_run_on_the_asymmetric_rig_split_anywhere_gives_the_same_bits() -> None:
    chosen, setup, (x, w) = (
        load(twin.models, "force-both", FibreModel),
        rig("asymmetric").setup(),
        trapezoid(0.6, 0.02, 2.0, 0.125),
    )
    drive, k = np.stack([x, w], axis=1), chosen.constants(setup, {})
    whole, parts, state = np.empty((len(x) - 1, 3)), np.empty((len(x) - 1, 3)), chosen.start(k, Start())
    chosen.advance(k, chosen.start(k, Start()), drive, DT, whole)
    for a in range(0, len(x) - 1, 37):
        b = min(a + 37, len(x) - 1)
        chosen.advance(k, state, np.ascontiguousarray(drive[a : b + 1]), DT, parts[a:b])
    assert np.array_equal(whole, parts)
