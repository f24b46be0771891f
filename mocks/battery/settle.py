"""Sizes settled on the stand that hides them: an effect's strength depends on the stand and on its motions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from mocks.battery.calibrate import main_size
from mocks.battery.draw import PULLS, Case, distance_of, size_for
from mocks.battery.strength import strength
from mocks.effects import Value, find
from mocks.plant.motion import targets
from mocks.plant.plant import GRID, Plant

WINDOWS, SECONDS = 5, 7.5
STEP = 4.0  # times the wanted strength, at which the effect's power law is read a second time
NEAR = 1.25  # a strength within this factor of the wanted one is left alone
#: effects that show only where the motion reaches: (signal, parameter)
REACH = {
    "end-stop": ("u", "position"),
    "dial-gauge-saturation": ("u", "level"),
    "force-gauge-saturation": ("F", "level"),
}
BEYOND = 0.005, 0.03  # the share of all samples that would lie beyond such a limit


def settled(case: Case) -> tuple[Case, dict[str, float]]:
    """The case with its effects as strong as wanted where their ranges allow it, and the strengths then measured.

    A base parameter shows by its own pull alone and keeps its size; its strength is that pull, in stated sigmas. A hum
    keeps its size, too: its table is in the signal's own unit.
    """
    hidden, reached = dict(case.hidden), {}
    for name in hidden:
        if name in REACH:
            hidden[name] = _within_reach(case, name)
        elif name in PULLS or name == "mains-hum":
            reached[name] = case.wanted[name]
            continue
        measured = _measure(case, {name: hidden[name]})
        if name not in REACH and not 1 / NEAR < measured / case.wanted[name] < NEAR:
            hidden[name] = _moved(name, hidden[name], measured, case.wanted[name])
            measured = _measure(case, {name: hidden[name]})
        reached[name] = round(measured, 3)
    return replace(case, hidden=hidden), reached


def _measure(case: Case, hidden: Mapping[str, Mapping[str, Value]]) -> float:
    return strength(case.stand, hidden, case.motions, SECONDS, WINDOWS)


def _moved(name: str, values: Mapping[str, Value], measured: float, wanted: float) -> dict[str, Value]:
    """The size that would be as strong as wanted by the effect's power law through what was measured."""
    main = main_size(find(name))
    null, low, high = distance_of(main)
    here = float(values[main.name])
    near, far = (abs(size_for(name, times * wanted) - null) for times in (1.0, STEP))
    slope = max(abs(math.log(far / near)) / math.log(STEP), 0.1)
    factor = math.exp(float(np.clip(slope * math.log(wanted / max(measured, 1e-3)), -2.5, 2.5)))
    distance = min(max(abs(here - null) * factor, low), high)
    return dict(values) | {main.name: null + math.copysign(distance, here - null)}


def _within_reach(case: Case, name: str) -> dict[str, Value]:
    """A limit that a small share of the campaign's samples would pass."""
    signal, parameter = REACH[name]
    reached = []
    for motion in case.motions:
        plant = Plant(case.stand.with_mass(motion.added_mass).believed, {})
        values = getattr(plant.follow(targets(motion, SECONDS, GRID)), signal)
        reached.append(values - (values[0] if signal == "u" else 0.0))
    share = np.random.default_rng([case.seed, 5]).uniform(*BEYOND)
    return dict(case.hidden[name]) | {parameter: round(float(np.quantile(np.concatenate(reached), 1.0 - share)), 6)}
