"""Simulated experiments: an order's motion on the nominal stand, or a recorded motion, through a model."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from api.catalogue import find_model
from api.orders import Order, make_plan
from stand.errors import InputError
from stand.recording import Recording, write_recording
from stand.recording.model import CHANNELS, F, U, X

if TYPE_CHECKING:
    from twin.simulate import Simulated

RATE = 2000.0


def ordered(order: Order) -> Recording:
    """The order's planned motion on the nominal stand as a recording without measured u and F (zeros)."""
    from stand.config import load_stand

    stand = load_stand()
    excitation = order.excitation()
    plan = make_plan(excitation, stand)
    t = np.arange(round(plan.duration * RATE)) / RATE
    nothing = np.zeros_like(t)
    channels = {X.name: plan.at(t)[0], U.name: nothing, F.name: nothing}
    return Recording(None, order.setup(stand), t, channels, excitation=excitation)


def simulate(run: Recording, name: str) -> tuple[Simulated, float]:
    """The run's motion through the model `name`, and how long that took, s (compilation not counted)."""
    from twin.model import Start
    from twin.simulate import simulate as through

    model, parameters, setup = find_model(name, run.setup)
    if run.setup.system not in model.systems:
        known = ", ".join(sorted(model.systems))
        raise InputError("the model does not know this rig", where=name, value=str(run.setup.system), remedy=known)
    model.warm()
    began = time.perf_counter()
    found = through(setup, run.time, run.channels.get(X.name, np.zeros_like(run.time)), model, parameters, Start())
    return found, time.perf_counter() - began


def summary(found: Simulated) -> dict[str, Any]:
    """Ranges of u (m) and F (N), and the share of samples without tension."""
    return {
        "weight_position": [float(found.u.min()), float(found.u.max())],
        "fibre_force": [float(found.F.min()), float(found.F.max())],
        "slack_fraction": float(np.mean(found.F <= 0.0)),
    }


def save_simulated(run: Recording, found: Simulated, path: Path) -> Path:
    """Write the simulation as a recording of its own; InputError where the file exists."""
    if path.exists():
        raise InputError("exists already", where=str(path), remedy="Choose another name")
    known = {c.name for c in CHANNELS[run.setup.system]}
    values = {**run.channels, U.name: found.u, F.name: found.F}
    channels = {name: series for name, series in values.items() if name in known}
    return write_recording(replace(run, path=path, channels=channels, quality=None, uncertainty={}), path)
