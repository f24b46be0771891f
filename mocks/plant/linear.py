"""A mass on a guide under a known force: an axis whose controller follows a motion and reports the force it gives."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mocks.plant.forces import SIZE, guide_force, relax
from mocks.plant.plant import GRID
from mocks.plant.rig import Rig
from mocks.plant.stages import Float as Series
from mocks.plant.world import World

Float = NDArray[np.float64]

BANDWIDTH = 60.0  # rad/s of the axis's position loop
CYCLE = 10  # grid steps between two decisions of its controller


@njit(cache=True)
def drive_axis(targets, dt, mass, bandwidth, p_record, tables, out):  # type: ignore[no-untyped-def]
    """Steps of M x'' = force - friction; targets [n, 3]; out [n, 3] x, x', force."""
    p = p_record[0]
    y = np.zeros(SIZE)
    bristle, force = 0.0, 0.0
    for i in range(len(out)):
        if i % CYCLE == 0:
            off, slip = targets[i, 0] - y[0], targets[i, 1] - y[1]
            force = mass * (targets[i, 2] + bandwidth * bandwidth * off + 2.0 * bandwidth * slip)
        bristle = relax(bristle, y[1], p.friction_velocity, p.presliding, dt)
        friction = guide_force(i * dt, y, p.rest_tension, bristle, p, tables)
        a = (force - friction) / mass
        y[0] += dt * (y[1] + 0.5 * dt * a)
        y[1] += dt * a
        out[i, 0], out[i, 1], out[i, 2] = y[0], y[1], force


def axis(
    rig: Rig, targets: Float, hidden: Mapping[str, Mapping[str, float | str]] | None = None
) -> tuple[World, Series, Series, Series]:
    """World, time, position and reported force on the plant's grid for targets [n, 3] on it."""
    world = World.of(rig, hidden or {})
    world.physics.mass = rig.moving_mass
    record, tables = world.record(), world.tables.packed()
    out = np.empty((len(targets), 3))
    drive_axis(np.ascontiguousarray(targets), GRID, rig.moving_mass, BANDWIDTH, record, tables, out)
    time = np.linspace(GRID, len(out) * GRID, len(out))
    force = np.ascontiguousarray(out[:, 2])
    for stage in world.sensors["fibre_force"]:
        force = stage(time, force, out)
    return world, time, np.ascontiguousarray(out[:, 0]), force


def wander(seconds: float, seed: int, reach: float = 0.07) -> Float:
    """Targets [n, 3] that use the axis: a sum of eased sines from 0.15 to 2.5 Hz, 1 s of rest before and after."""
    rng = np.random.default_rng(seed)
    time = np.linspace(GRID, seconds, round(seconds / GRID))
    x = np.zeros_like(time)
    for frequency in (0.15, 0.4, 1.1, 2.5):
        size = reach * rng.uniform(0.6, 1.0) * 0.15 / frequency
        x += size * np.sin(2.0 * math.pi * frequency * (time - 1.0) + rng.uniform(-math.pi, math.pi))
    share = np.clip(np.minimum(time - 1.0, seconds - 1.0 - time), 0.0, 1.0)
    x *= share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    v = np.gradient(x, GRID)
    return np.stack([x, v, np.gradient(v, GRID)], axis=-1)
