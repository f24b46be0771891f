"""The rigs: their data, the strand's geometry and what the fibre does to the guide."""

from __future__ import annotations

import math

import pytest

import twin.rigs
from stand.errors import InputError
from stand.setup import check
from tests.twin.fibre_runs import held, run
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


@pytest.mark.parametrize("name", ["point-mass", "ritz"])
def test_on_the_asymmetric_rig_the_fibre_carries_the_weight_over_its_cosine(name: str) -> None:
    setup = rig("asymmetric").setup().with_values(guide_friction=0.0)
    out = run(name, setup, *held(1.0))
    assert out[-1, 2] == pytest.approx(rest_tension(setup), abs=setup.fibre_mass * setup.gravity)
    assert abs(out[-1, 0]) < 1e-5
