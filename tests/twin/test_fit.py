"""The fit finds what made the data, says how well, and says so where the data cannot tell."""

from __future__ import annotations

from types import MappingProxyType

import numpy as np
import pytest

import twin.models
from stand.errors import InputError
from stand.recording import Recording
from stand.setup import Setup, nominal
from tests.twin.fibre_runs import DT, trapezoid
from twin.fit import fit
from twin.model import FibreModel
from twin.plugins import load
from twin.simulate import simulate


def recorded(truth: Setup, believed: Setup, seed: int = 0, seconds: float = 4.0, frequency: float = 1.25) -> Recording:
    """A run of the force model with `truth`, sensors' noise added; its file says `believed`."""
    rng = np.random.default_rng(seed)
    x, _ = trapezoid(seconds - 2.0, 0.03, frequency, 0.2)
    x = np.concatenate([np.zeros(2000), x, np.full(2000, x[-1])])
    time = np.arange(len(x)) * DT
    run = simulate(truth, time, x, load(twin.models, "force", FibreModel))
    noise = rng.normal(size=(3, len(x))) * np.array([[1e-6], [1e-5], [0.05]])
    channels = {"drive_position": x + noise[0], "weight_position": run.u + noise[1], "fibre_force": run.F + noise[2]}
    return Recording(None, believed, time, MappingProxyType(channels))


def test_it_finds_the_stiffness_and_damping_that_made_the_run() -> None:
    truth = nominal().with_values(fibre_stiffness=36.5e3, fibre_damping=24.0)
    found = fit([recorded(truth, nominal())], "force", ["fibre_stiffness", "fibre_damping"])
    by_name = {p.name: p for p in found.parameters}
    for name, value in (("fibre_stiffness", 36.5e3), ("fibre_damping", 24.0)):
        p = by_name[name]
        assert p.determined
        assert p.value == pytest.approx(value, rel=0.02)
        assert abs(p.value - value) < 5 * p.std
    assert found.after < 0.5 * found.before
    assert found.to_json()["parameters"]["fibre_stiffness"]["units"] == "N/m"


def test_it_says_what_the_data_do_not_determine() -> None:
    """Three that scale alike: mass, stiffness, damping and friction against an unscaled force tell; wrap does not."""
    found = fit([recorded(nominal(), nominal(), seed=1)], "force", ["fibre_stiffness", "wrap_angle"])
    by_name = {p.name: p for p in found.parameters}
    assert by_name["fibre_stiffness"].determined
    assert not by_name["wrap_angle"].determined
    assert "do not determine" in by_name["wrap_angle"].note


def test_psi_finds_the_friction_on_a_slow_run() -> None:
    truth = nominal().with_values(guide_friction=4.0)
    run = recorded(truth, nominal(), seed=2, frequency=1.0)
    found = fit([run], "force", ["guide_friction"], criterion="psi")
    assert found.after <= found.before
    assert found.parameters[0].value == pytest.approx(4.0, rel=0.1)


def test_names_that_nothing_has_are_refused_with_those_that_are_known() -> None:
    run = recorded(nominal(), nominal())
    with pytest.raises(InputError, match="fibre_stiffness"):
        fit([run], "force", ["nonsense"])
    with pytest.raises(InputError, match="unknown criterion"):
        fit([run], "force", ["fibre_stiffness"], criterion="R")
