"""Every cause in the folder: physics with a source, units that are units, and no effect at null."""

import numpy as np
import pytest

import twin.causes
from stand.setup import Setup, System
from stand.units import parse_unit
from twin.causes._kind import Cause
from twin.diagnosis.composition import Composition
from twin.kernels import composed
from twin.plugins import every, load, names

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

CAUSES = [variant for cause in every(twin.causes, Cause) for variant in cause.variants or (cause,)]


def simulated(model: Composition, z: np.ndarray) -> np.ndarray:
    """A quarter of a second of a 2 Hz motion, true signals."""
    dt, n = 5e-4, 520
    time = np.arange(n) * dt
    x = 0.01 * (1 - np.cos(4 * np.pi * time))
    drive = np.column_stack([x, np.gradient(x, dt)])
    constants = model.constants(z, [model.setups[0].rest_tension])
    before, after = model.hooks(z, "before"), model.hooks(z, "after")
    out, status = np.empty((1, 500, 5)), np.zeros(1, np.int64)
    one = np.zeros(1, np.int64)
    composed.windows(
        np.zeros((1, 4)), np.zeros((1, 8)), constants, one, one + 2, 500, drive, dt,
        before.address, before.p, after.address, after.p, one, out, status,
    )  # fmt: skip
    assert status[0] == 0
    return out


def test_the_folder_holds_the_catalogue() -> None:
    assert set(CATALOGUE) <= set(names(twin.causes))


@pytest.mark.parametrize("cause", CAUSES, ids=lambda c: c.name)
def test_a_cause_states_its_source_its_units_and_known_rivals(cause: Cause) -> None:
    assert str(cause.source)
    assert all(parse_unit(p.unit) and p.bounds[0] <= p.value <= p.bounds[1] for p in cause.parameters)
    assert set(cause.rivals) <= {*names(twin.causes), *(c.name for c in CAUSES)}


@pytest.mark.parametrize(
    "cause", [c for c in CAUSES if c.before is not None or c.after is not None], ids=lambda c: c.name
)
def test_a_cause_at_null_changes_nothing(cause: Cause) -> None:
    plain = Composition((Setup(),), ())
    model = Composition((Setup(),), (cause,))
    np.testing.assert_allclose(
        simulated(model, model.zero()), simulated(plain, plain.zero()), rtol=0, atol=1e-3
    )  # N; u is far below


def test_a_stiffer_fibre_is_stiffer_by_its_parameter() -> None:
    cause = load(twin.causes, "fibre-stiffness", Cause)
    model = Composition((Setup(),), (cause,))
    z = model.put(model.zero(), cause, {"difference": 1000.0})
    assert model.setup(z, 0).fibre_stiffness == pytest.approx(35e3)
    assert System.WFPD in cause.systems
