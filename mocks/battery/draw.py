"""Which stands a battery has: effect, size, operator's errors, noise and motions, all from one seed."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from mocks.battery.calibrate import main_size
from mocks.effects import Effect, Size, Value, everything, find
from mocks.plant.campaign import draw_motions
from mocks.plant.motion import Motion
from mocks.plant.operator import BASE, Stand, draw_stand
from mocks.plant.rig import Rig
from mocks.record import Noise

KINDS = ("single", "clean", "double", "outside")
RUNS = 6  # of a campaign
PER_CAUSE, CLEAN, DOUBLE, OUTSIDE = 5, 150, 60, 30
STRENGTHS = (6.0, 1.5, 10.0, 3.0, 18.0)  # wanted, cause by cause in turn
CLEAR = (5.0, 16.0)  # wanted range where two are hidden, or one outside the catalogue
PULLS = dict(BASE) | {"force-gauge-scale": "weight_mass"}  # all forces and masses alike: only the priors tell
MOST = 0.8  # of a value that a difference takes away
HUM = {"fibre_force": 1.0, "weight_position": 5e-5, "drive_position": 5e-5}  # amplitude against that in N


@dataclass(frozen=True)
class Case:
    """One stand to be diagnosed: nothing in it is written to disk but by `mocks.battery.store`.

    kind: one of KINDS. wanted: the strength each hidden effect was drawn for. seed: of its recordings.
    """

    number: int
    kind: str
    hidden: Mapping[str, Mapping[str, Value]]
    wanted: Mapping[str, float]
    stand: Stand
    motions: tuple[Motion, ...]
    noise: Noise
    seed: int

    @property
    def name(self) -> str:
        """Its folder: nothing but a number."""
        return f"stand-{self.number:04d}"


def battery(seed: int, kinds: Sequence[str] = KINDS, share: float = 1.0, runs: int = RUNS) -> list[Case]:
    """All stands of a seed, mixed; share < 1 keeps that part of each kind (at least one of each).

    runs: how many of each campaign's runs there are, drawn; what is hidden is then as strong as wanted in these alone.
    """
    plan = [entry for kind in kinds for entry in _some(_PLANS[kind](seed), share, seed)]
    order = np.random.default_rng([seed, 99]).permutation(len(plan))
    cases = [_case(seed, number, *plan[k]) for number, k in enumerate(order)]
    return cases if runs >= RUNS else [_shortened(case, runs) for case in cases]


def _shortened(case: Case, runs: int) -> Case:
    kept = np.random.default_rng([case.seed, 6]).permutation(len(case.motions))[:runs]
    return replace(case, motions=tuple(case.motions[k] for k in sorted(kept)))


Plan = tuple[str, tuple[tuple[str, float], ...], int]  # kind, (effect, wanted strength) ..., its own number


def _some(plan: list[Plan], share: float, seed: int) -> list[Plan]:
    """A part of the plan, drawn, in its order."""
    keep = np.random.default_rng([seed, 98]).permutation(len(plan))[: max(1, round(share * len(plan)))]
    return [plan[k] for k in sorted(keep)]


def _singles(seed: int) -> list[Plan]:
    names = [e.name for e in everything() if e.catalogued]
    return [("single", ((n, STRENGTHS[k % len(STRENGTHS)]),), k) for k in range(PER_CAUSE) for n in names]


def _cleans(seed: int) -> list[Plan]:
    return [("clean", (), k) for k in range(CLEAN)]


def _doubles(seed: int) -> list[Plan]:
    """Pairs that act on different parts of the stand."""
    rng = np.random.default_rng([seed, 7])
    catalogue = [e for e in everything() if e.catalogued]
    plans: list[Plan] = []
    while len(plans) < DOUBLE:
        first, second = (catalogue[k] for k in rng.choice(len(catalogue), 2, replace=False))
        if first.acts_on != second.acts_on:
            plans.append(("double", ((first.name, _clear(rng)), (second.name, _clear(rng))), len(plans)))
    return plans


def _outsides(seed: int) -> list[Plan]:
    rng = np.random.default_rng([seed, 8])
    names = [e.name for e in everything() if not e.catalogued]
    return [("outside", ((names[k % len(names)], _clear(rng)),), k) for k in range(OUTSIDE)]


def _clear(rng: np.random.Generator) -> float:
    """A strength that is well seen."""
    return math.exp(rng.uniform(math.log(CLEAR[0]), math.log(CLEAR[1])))


_PLANS = {"single": _singles, "clean": _cleans, "double": _doubles, "outside": _outsides}


def _case(seed: int, number: int, kind: str, effects: tuple[tuple[str, float], ...], own: int) -> Case:
    rng = np.random.default_rng([seed, KINDS.index(kind), own, *(_key(name) for name, _ in effects)])
    stand = draw_stand(rng, draw_belief(rng), errors=1.0)
    hidden = {name: draw_values(find(name), wanted, stand, rng) for name, wanted in effects}
    motions = tuple(draw_motions(rng))
    return Case(number, kind, hidden, dict(effects), stand, motions, draw_noise(rng), int(rng.integers(2**31)))


def _key(name: str) -> int:
    return int.from_bytes(name.encode(), "little") % (2**31)


def draw_belief(rng: np.random.Generator) -> Rig:
    """What an operator may have built: the nominal stand, or for half of them one that is a little different."""
    rig = Rig()
    if rng.random() < 0.5:
        return rig
    changes = {"fibre_stiffness": 0.15, "fibre_damping": 0.25, "guide_friction": 0.15, "pulley_inertia": 0.25}
    values = {name: float(f"{getattr(rig, name) * rng.uniform(1 - s, 1 + s):.2g}") for name, s in changes.items()}
    return rig.but(**values)


def draw_noise(rng: np.random.Generator) -> Noise:
    """Sensors about as noisy as they should be."""
    return Noise(x=5e-6 * rng.uniform(0.3, 1.0), u=6e-6 * rng.uniform(0.8, 1.2), F=0.12 * rng.uniform(0.8, 1.2))


def draw_values(effect: Effect, wanted: float, stand: Stand, rng: np.random.Generator) -> dict[str, Value]:
    """Parameters of an effect that shows about as strongly as wanted; places, phases, times over their ranges."""
    main = main_size(effect)
    values = {s.name: _free(s, rng) for s in effect.sizes if s is not main}
    distance = _distance(effect.name, wanted, stand)
    sign = -1.0 if main.signed and rng.random() < 0.5 else 1.0
    values[main.name] = _null(main) + sign * distance * HUM.get(str(values.get("signal")), 1.0)
    return values


def _distance(name: str, wanted: float, stand: Stand) -> float:
    """How far from the null: for a base parameter `wanted` of its stated sigmas (it shows by its pull alone)."""
    if name not in PULLS:
        return abs(size_for(name, wanted) - _null(main_size(find(name))))
    sigma, value = stand.uncertainty[PULLS[name]], float(getattr(stand.believed, PULLS[name]))
    if name == "force-gauge-scale":
        return wanted * sigma / value
    most = MOST * value
    return min(wanted * sigma, most) * (180.0 / math.pi if name == "incline-angle" else 1.0)


def _free(size: Size, rng: np.random.Generator) -> Value:
    return str(rng.choice(size.choices)) if size.choices else float(rng.uniform(size.low, size.high))


def _null(main: Size) -> float:
    """The null where it is finite; what has none (levels, places) is far from 0."""
    return main.null if math.isfinite(main.null) else 0.0


def distance_of(main: Size) -> tuple[float, float, float]:
    """The null of a size, and how near and how far from it a draw may lie."""
    null = _null(main)
    ends = sorted((abs(main.low - null), abs(main.high - null)))
    return null, ends[0], ends[1]


def size_for(name: str, wanted: float) -> float:
    """Size at which an effect shows about as strongly as wanted: a power law through the measured table, in range."""
    table, main = np.array(_measured()[name]), main_size(find(name))
    null = _null(main)
    power, factor = np.polyfit(np.log(np.abs(table[:, 0] - null)), np.log(table[:, 1]), 1)
    wished = (math.log(wanted) - factor) / power
    ends = (math.log(abs(main.low - null)), math.log(abs(main.high - null)))
    return null + math.exp(min(max(wished, min(ends)), max(ends)))


@cache
def _measured() -> dict[str, list[list[float]]]:
    table: dict[str, list[list[float]]] = json.loads(Path(__file__).with_name("strengths.json").read_text())
    return table
