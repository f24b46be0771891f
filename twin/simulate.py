"""Run a fibre model over a motion of the drive, from rest or from any measured instant."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError, StandError
from stand.setup import Setup
from twin.model import FibreModel, Start, Status

Float = NDArray[np.float64]


@dataclass(frozen=True)
class Simulated:
    """What a model gives on a recording's time: u m, v m/s, F N, each [n]; state: the model's state at the end."""

    time: Float
    u: Float
    v: Float
    F: Float
    state: Float = field(default_factory=lambda: np.empty(0))


def check_system(model: FibreModel, setup: Setup) -> None:
    """InputError where the model is not for the setup's rig."""
    if setup.system not in model.systems:
        known = ", ".join(sorted(model.systems))
        raise InputError(
            "the model does not work on this rig",
            where=model.name,
            value=str(setup.system),
            remedy=f"It works on {known}",
        )


def simulate(
    setup: Setup,
    time: Float,
    x: Float | None,
    model: FibreModel,
    parameters: Mapping[str, float] | None = None,
    start: Start | None = None,
) -> Simulated:
    """u, u', F of `model` at `time` under the drive position x (None on a rig without a drive), from `start`.

    The first sample is the start itself. StandError with the kernel's sentence where it gave up.
    """
    from twin.kernels.hermite import drive_table

    check_system(model, setup)
    dt = float(time[-1] - time[0]) / (len(time) - 1)
    drive = np.zeros((len(time), 2)) if x is None else drive_table(x, dt)
    start = start if start is not None else Start(x=drive[0, 0], w=drive[0, 1])
    constants = model.constants(setup, parameters or {})
    state, out = run_table(model, constants, start, drive, dt)
    return Simulated(time, out[:, 0], out[:, 1], out[:, 2], state)


def run_table(model: FibreModel, constants: Float, start: Start, drive: Float, dt: float) -> tuple[Float, Float]:
    """The state at the end and u, u', F [n, 3] at every sample of `drive`, the first being the start."""
    state = np.asarray(model.start(constants, start))
    out = np.empty((len(drive), 3))
    out[0] = start.u, start.v, first_force(model, constants, state, drive[0], dt)
    status = model.advance(constants, state, drive, dt, out[1:])
    if status != Status.THE_MODEL_REACHED_THE_LAST_SAMPLE:
        raise StandError(
            Status(status).sentence,
            where=f"model {model.name}",
            value=int(status),
            remedy="Check the setup's stiffness, damping and masses, and the drive position for jumps",
        )
    return state, out


def first_force(model: FibreModel, constants: Float, state: Float, drive: Float, dt: float) -> float:
    """F at the start itself: a vanishing step (1e-9 of a sample) from a copy of the state."""
    tiny, out = 1e-9 * dt, np.empty((1, 3))
    ahead = np.array([drive, [drive[0] + drive[1] * tiny, drive[1]]])
    model.advance(constants, state.copy(), ahead, tiny, out)
    return float(out[0, 2])
