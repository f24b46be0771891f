"""The mains sing in one signal; amplitude in that signal's unit (N or m)."""

import math

import numpy as np

from mocks.effects import Effect, Size
from mocks.plant.world import World


def act(world: World, amplitude: float, frequency: float, signal: str, phase: float) -> None:
    """Adds the hum to the signal."""
    omega = 2.0 * math.pi * frequency
    world.sensors[signal].append(lambda time, values, truth: values + amplitude * np.sin(omega * time + phase))


EFFECT = Effect(
    "mains-hum",
    "wiring",
    (
        Size("amplitude", "-", 0.5, 0.04, 2.0),
        Size("frequency", "Hz", 50.0, 49.5, 50.5, steady=True),
        Size("signal", "", "fibre_force", choices=("fibre_force", "weight_position", "drive_position")),
        Size("phase", "rad", 0.4, -3.1, 3.1, steady=True),
    ),
    act,
    systems=("weight-fibre-pulley-drive", "weight-fibre"),
)
