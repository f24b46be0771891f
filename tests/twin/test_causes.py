"""Every cause in the folder: physics with a source, units that are units, and no effect at null."""

from dataclasses import replace

import numpy as np
import pytest

import twin.causes
from stand.setup import Setup, System, nominal
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


def simulated(
    model: Composition, z: np.ndarray, *, stroke: float = 0.02, u: float = 0.0, w: float = 0.0, count: int = 500
) -> np.ndarray:
    """A quarter of a second of a 2 Hz motion (or another count of samples) from u and the rim speed w, true signals."""
    dt, n = 5e-4, count + 20
    time = np.arange(n) * dt
    x = 0.5 * stroke * (1 - np.cos(4 * np.pi * time))
    drive = np.column_stack([x, np.gradient(x, dt)])
    constants = model.constants(z, [model.setups[0].rest_tension])
    before, after = model.hooks(z, "before"), model.hooks(z, "after")
    out, status = np.empty((1, count, 5)), np.zeros(1, np.int64)
    one = np.zeros(1, np.int64)
    composed.windows(
        np.array([[u, 0.0, 0.0, w]]), np.zeros((1, 8)), constants, one, one + 2, count, drive, dt,
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


def test_a_fibre_without_a_pulley_hangs_from_an_end_that_stands() -> None:
    model = Composition((nominal(System.WF),), ())
    moving, standing = (simulated(model, model.zero(), stroke=0.0, u=-0.001, w=w) for w in (0.03, 0.0))
    np.testing.assert_array_equal(moving, standing)
    assert np.ptp(moving[0, :, 0]) > 1e-4


@pytest.mark.parametrize("friction", [0.1, 0.4, 1.0])
def test_a_fibre_that_slides_when_it_is_caught_does_not_drive_the_rim_away(friction: float) -> None:
    cause = load(twin.causes, "fibre-pulley-slip", Cause)
    model, plain = Composition((Setup(),), (cause,)), Composition((Setup(),), ())
    z = model.put(model.zero(), cause, {"friction": friction})
    dropped, held = (simulated(m, y, stroke=0.0, u=0.004, count=400)[0] for m, y in ((model, z), (plain, plain.zero())))
    assert np.abs(dropped[:, 4]).max() < 0.004  # m of rim
    assert dropped[:, 2].max() == pytest.approx(held[:, 2].max(), rel=0.1)


def test_a_stiffer_fibre_is_stiffer_by_its_parameter() -> None:
    cause = load(twin.causes, "fibre-stiffness", Cause)
    model = Composition((Setup(),), (cause,))
    z = model.put(model.zero(), cause, {"difference": 1000.0})
    assert model.setup(z, 0).fibre_stiffness == pytest.approx(35e3)
    assert System.WFPD in cause.systems


def chain_frequency(setup: Setup, mass: float, pieces: int = 80) -> float:
    """Hz: of weight and rim on strands whose mass sits in many small lumps, the drive at rest, its lowest."""
    line = mass / setup.fibre_length
    arc = setup.fibre_length - setup.weight_strand_length - setup.drive_strand_length
    n = 2 * pieces
    m, k = np.zeros(n + 1), np.zeros((n + 1, n + 1))
    m[0], m[pieces] = setup.mass, setup.pulley_inertia / setup.pulley_radius**2 + line * arc
    whole = setup.fibre_stiffness * setup.free_length
    for i in range(n):
        length = (setup.weight_strand_length if i < pieces else setup.drive_strand_length) / pieces
        m[[i, i + 1]] += 0.5 * line * length
        k[i : i + 2, i : i + 2] += whole / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    scaled = k[:n, :n] / np.sqrt(np.outer(m[:n], m[:n]))
    return float(np.sqrt(np.linalg.eigvalsh(scaled)[0]) / (2 * np.pi))


@pytest.mark.parametrize("mass", [0.1, 0.6])
def test_a_heavy_fibre_swings_as_one_in_many_small_lumps(mass: float) -> None:
    setup = replace(Setup(), guide_friction=0.0, fibre_damping=0.0)
    model = Composition((setup,), (load(twin.causes, "fibre-mass", Cause),))
    out = simulated(
        model, model.put(model.zero(), model.causes[0], {"mass": mass}), stroke=0.0, u=-1e-4, count=4000
    )  # taut throughout: at rest it is 0.45 mm long
    u = out[0, :, 0]
    up = np.flatnonzero((u[:-1] < 0.0) & (u[1:] >= 0.0))
    crossings = (up - u[up] / (u[up + 1] - u[up])) * 5e-4
    measured = (len(crossings) - 1) / (crossings[-1] - crossings[0])
    assert measured == pytest.approx(chain_frequency(setup, mass), rel=1e-3)
    assert measured < chain_frequency(setup, 1e-6) * (1.0 - 0.03 * mass)
