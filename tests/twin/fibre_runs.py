"""What the tests of the discretised fibres share: runs, motions, frequencies and the linear systems they must match."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

import twin.models
from stand.setup import Setup, System, nominal
from twin.model import FibreModel, Start
from twin.plugins import load
from twin.rigs import axial_stiffness

Float = NDArray[np.float64]
DT = 5e-4
LOCKED = 1e6  # kg m^2: a pulley that does not turn


def model(name: str) -> FibreModel:
    return load(twin.models, name, FibreModel)


def smooth(**changes: float) -> Setup:
    """The nominal stand with a frictionless guide."""
    return nominal().with_values(guide_friction=0.0, **changes)


def hanging(**changes: float) -> Setup:
    """The weight-fibre rig in free fall, frictionless."""
    return nominal(System.WF).with_values(guide_friction=0.0, incline_angle=math.pi / 2, **changes)


def run(
    name: str,
    setup: Setup,
    x: Float,
    w: Float,
    parameters: Mapping[str, float] | None = None,
    start: Start | None = None,
    dt: float = DT,
) -> Float:
    """u, u', F [n, 3] after each interval of the drive's motion x, w [n + 1]; the model must reach the end."""
    chosen = model(name)
    constants = chosen.constants(setup, parameters or {})
    state = chosen.start(constants, start or Start(x=x[0], w=w[0]))
    out = np.empty((len(x) - 1, 3))
    assert chosen.advance(constants, state, np.ascontiguousarray(np.stack([x, w], axis=1)), dt, out) == 0
    return out


def held(seconds: float, dt: float = DT) -> tuple[Float, Float]:
    """A drive that stands still."""
    x = np.zeros(round(seconds / dt) + 1)
    return x, x


def sine(seconds: float, amplitude: float, frequency: float, dt: float = DT) -> tuple[Float, Float]:
    """A quasi-sinusoid from rest, `amplitude` peak to peak: taut below 3.9 m/s^2."""
    t, k = np.arange(round(seconds / dt) + 1) * dt, 2 * np.pi * frequency
    return amplitude / 2 * (1 - np.cos(k * t)), amplitude / 2 * k * np.sin(k * t)


def pull(stroke: float, speed: float, dt: float = DT) -> tuple[Float, Float]:
    """Half a second of soft start, then `speed` until `stroke`."""
    t = np.arange(round((stroke / speed + 0.25) / dt) + 1) * dt
    w = speed * np.clip(t / 0.5, 0, 1) ** 2 * (3 - 2 * np.clip(t / 0.5, 0, 1))
    return np.concatenate([[0.0], np.cumsum((w[1:] + w[:-1]) / 2) * dt]), w


def trapezoid(seconds: float, stroke: float, frequency: float, ramp: float, dt: float = DT) -> tuple[Float, Float]:
    """Trapezoidal motion with quintic ramps."""
    t = np.arange(round(seconds / dt) + 1) * dt
    phase, hold = t % (1 / frequency), 0.5 / frequency - ramp
    part = np.clip(phase / ramp, 0, 1) - np.clip((phase - ramp - hold) / ramp, 0, 1)
    x = stroke * part**3 * (10 - 15 * part + 6 * part**2)
    return x, np.gradient(x, dt)


def frequency(u: Float, rest: float, cycles: int, dt: float = DT) -> float:
    """Hz, from the upward crossings of u through `rest`."""
    y = u - rest
    at = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))[: cycles + 1]
    crossing = at - y[at] / (y[at + 1] - y[at])
    return float((len(crossing) - 1) / (crossing[-1] - crossing[0]) / dt)


def free_vibration(name: str, setup: Setup, parameters: Mapping[str, float] | None = None, cycles: int = 6) -> float:
    """Hz of the weight after a small pull down-slope, the drive held."""
    out = run(name, setup, *held(1.2), parameters, Start(u=-1e-4))
    return frequency(out[:, 0], float(out[-200:, 0].mean()), cycles)


def lowest(stiffness: Float, mass: Float) -> float:
    """Hz of the lowest mode of a linear system; mass [n] is lumped."""
    root = np.sqrt(mass)
    return math.sqrt(np.linalg.eigvalsh(stiffness / np.outer(root, root))[0]) / (2 * math.pi)


def chain(springs: list[tuple[int, int, float]], mass: list[float]) -> float:
    """Hz of masses joined by springs (i, j, stiffness); j = -1 is the ground."""
    k = np.zeros((len(mass), len(mass)))
    for i, j, c in springs:
        k[i, i] += c
        if j >= 0:
            k[j, j] += c
            k[i, j] -= c
            k[j, i] -= c
    return lowest(k, np.array(mass))


def damped(setup: Setup, hertz: float) -> float:
    """The frequency with stiffness-proportional damping: f sqrt(1 - zeta^2), zeta = (b/c) omega / 2."""
    ratio = setup.fibre_damping / setup.fibre_stiffness * math.pi * hertz
    return hertz * math.sqrt(1 - ratio**2)


def point_mass_frequency(setup: Setup, masses: int = 7, bond: float = 0.005, friction: bool = True) -> float:
    """Hz of the point-mass chain along the fibre: its springs, its bond to the rim at the arc's middle, J / r^2."""
    ea, mass = axial_stiffness(setup), setup.fibre_mass / masses
    arc = setup.pulley_radius * setup.wrap_angle
    segment = (setup.free_length + arc) / (1 + setup.rest_tension / ea) / (masses + 1)
    middle = (setup.weight_strand_length + arc / 2) / (1 + setup.rest_tension / ea)
    rim, springs = (masses + 1, []) if setup.pulley_inertia < LOCKED else (-1, [])
    for i in range(masses + 1):
        nxt = i + 1 if i < masses else -1
        split = middle - i * segment
        if friction and 0 < split < segment:
            springs += [(i, rim, ea / (split + bond)), (rim, nxt, ea / (segment - split + bond))]
        else:
            springs.append((i, nxt, ea / segment))
    tail = [] if rim < 0 else [setup.pulley_inertia / setup.pulley_radius**2] if friction else []
    return damped(setup, chain(springs, [setup.mass] + [mass] * masses + tail))


@functools.cache
def _rod(length: float, first: float, last: float, cells: int) -> Float:
    return np.concatenate(
        [
            np.linspace(0, first, cells + 1),
            np.linspace(first, last, cells + 1)[1:],
            np.linspace(last, length, cells + 1)[1:],
        ]
    )


def foundation_frequency(setup: Setup, contact: float, bristle: float, cells: int = 60) -> float:
    """Hz of a rod whose arc lies on bristles (N/m^2) that turn with the pulley and sinks into the rim (N/m^2).

    Sinking by T/(r k_n) shortens the arc by T/(r^2 k_n) per length: it acts as an axial compliance there.
    """
    ea, arc = axial_stiffness(setup), setup.pulley_radius * setup.wrap_angle
    first, last = setup.weight_strand_length, setup.weight_strand_length + arc
    at = _rod(setup.free_length + arc, first, last, cells)
    size = np.diff(at)
    on_arc = (at[:-1] >= first - 1e-12) & (at[1:] <= last + 1e-12)
    soft = np.where(on_arc, 1 / (1 / ea + 1 / (setup.pulley_radius**2 * contact)), ea)
    n = len(size)
    rim = n if setup.pulley_inertia < LOCKED else -1
    springs = [(i, i + 1 if i + 1 < n else -1, soft[i] / size[i]) for i in range(n)]
    density = setup.fibre_mass / (setup.free_length + arc)
    mass = [setup.mass, *(density * (size[:-1] + size[1:]) / 2)]
    if rim >= 0:
        mass.append(setup.pulley_inertia / setup.pulley_radius**2)
    for i in range(1, n):
        share = bristle * (size[i - 1] * on_arc[i - 1] + size[i] * on_arc[i]) / 2
        if share:
            springs.append((i, rim, share))
    return damped(setup, chain(springs, mass))
