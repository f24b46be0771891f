"""What is left when the catalogue is done: where a latent term acts, on what it depends, its shape with error bars.

Hats in time at one place after the other (a force on the weight, on the rim, ...) give, to first order, what any
function of any variable at that place would explain: only the hats are simulated, functions are sums of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stand.setup import System
from twin.causes._kind import Cause
from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import Fitted, scale, slopes, weigh
from twin.diagnosis.normal import Linear, Reduced, reduce
from twin.diagnosis.problem import Problem
from twin.diagnosis.run import LENGTH
from twin.kernels import composed_latent as kernels
from twin.parameter import Parameter, Source

Float = NDArray[np.floating[Any]]
SPACING = 8
KNOTS, FINER = (8, 16, 28), (50, 80)
#: along which a term may be as fine as the pitch of a screw or of a rack
POSITIONS = ("weight_position", "drive_position", "pulley_angle")
PRICE = 14.0
#: frequencies that are tried together
AT_ONCE = 50
PLACES: Mapping[str, tuple[str, Any, float, str]] = {
    "guide": ("after", kernels.guide_hat, 0.5, "N"),
    "pulley": ("after", kernels.rim_hat, 0.5, "N"),
    "fibre": ("before", kernels.fibre_hat, 0.5, "N"),
    "dial-gauge": ("senses", kernels.dial_hat, 1e-5, "m"),
    "force-gauge": ("senses", kernels.gauge_hat, 0.5, "N"),
    "drive": ("moves", kernels.drive_hat, 1e-5, "m"),
}
ALLOWED: Mapping[str, tuple[str, ...]] = {
    "guide": ("weight_position", "weight_velocity", "fibre_force", "time", "frequency"),
    "pulley": ("pulley_angle", "drive_velocity", "fibre_force", "time", "frequency"),
    "fibre": ("weight_velocity", "fibre_force", "time"),
    "dial-gauge": ("weight_position", "weight_velocity", "time", "frequency"),
    "force-gauge": ("weight_position", "drive_position", "drive_velocity", "fibre_force", "time", "frequency"),
    "drive": ("drive_position", "drive_velocity", "time", "frequency"),
}


@dataclass(frozen=True)
class Term:
    """A function at a place: gain in weighted squares, knots and heights with one sigma; signed: against the motion."""

    place: str
    variable: str
    signed: bool
    gain: float
    x: Float
    y: Float
    std: Float
    frequency: float | None = None


@dataclass(frozen=True)
class Grams:
    """Hats at one place, starts eliminated: [w, h, h], [w, h], and against the globals [w, h, p]."""

    matrix: Float
    vector: Float
    cross: Float


def terms(problem: Problem, fitted: Fitted) -> list[Term]:
    """Every place with every variable it may depend on, most explaining first (less a price per knot)."""
    spread = scale(problem, fitted.residual)
    linear = slopes(problem, fitted)
    reduced = reduce(linear, fitted.starts, fitted.z)
    inverse = np.linalg.pinv(reduced.matrix, rcond=1e-12)
    simulated, _ = problem.simulate(fitted.model, fitted.z, fitted.starts)
    at, values = _nodes(problem, simulated)
    found: list[Term] = []
    for place in PLACES:
        if problem.system is not System.WFPD and place in ("pulley", "drive"):
            continue
        grams = _grams(problem, fitted, linear, reduced, spread, place)
        for variable in ALLOWED[place]:
            if variable == "frequency":
                found.append(_sinusoid(problem, place, grams, at))
                continue
            signs = (False, True) if place in ("guide", "pulley") and variable != "weight_velocity" else (False,)
            for signed in signs:
                found.append(_function(place, variable, signed, grams, values, inverse, reduced.vector))
    return sorted((t for t in found if np.isfinite(t.gain)), key=lambda t: -t.gain)


def _nodes(problem: Problem, simulated: Float) -> tuple[Float, Mapping[str, Float]]:
    """Each window's hats: time of hat h [w, TRAIN] and every variable there (nan where outside the window)."""
    w, dt = problem.windows, problem.dt
    first = w.first[:, None]
    wait = (np.arange(kernels.TRAIN)[None, :] * SPACING - first) % (kernels.TRAIN * SPACING)
    outside = wait >= LENGTH
    at = np.minimum(wait, LENGTH - 1)
    rows = np.arange(len(w))[:, None]
    drive = problem.drive[problem.offset[w.run][:, None] + first + at]
    radius = problem.runs[0].setup.pulley_radius or 1.0
    u, v, F, s = (simulated[rows, at, i] for i in (0, 1, 2, 4))
    values = {
        "weight_position": u, "weight_velocity": v, "fibre_force": F, "pulley_angle": s / radius,
        "drive_position": drive[..., 0], "drive_velocity": drive[..., 1], "time": (first + at) * dt,
    }  # fmt: skip
    values["speed sign"] = np.tanh(v / 0.002)
    return (first + wait) * dt, {n: np.where(outside, np.nan, x) for n, x in values.items()}


def _grams(
    problem: Problem, fitted: Fitted, linear: Linear, reduced: Reduced, spread: NDArray[np.float64], place: str
) -> Grams:
    hook, function, size, _ = PLACES[place]
    root = np.sqrt(weigh(fitted.residual, spread)) / spread * problem.windows.use
    here = problem.predict(fitted.model, fitted.z, fitted.starts)
    columns = []
    for h in range(kernels.TRAIN):
        cause = _pseudo(f"hat {h} at the {place}", hook, function, (size, float(h), SPACING * problem.dt))
        model = Composition(fitted.model.setups, (*fitted.model.causes, cause))
        there = problem.predict(model, fitted.model.carry(fitted.z, model), fitted.starts)
        columns.append(np.nan_to_num((there - here) / size * root).reshape(len(here), -1))
    d = np.array(columns).transpose(1, 0, 2)
    own = linear.starts.transpose(1, 0, 2)
    cross = d @ own.transpose(0, 2, 1)
    solved = np.linalg.solve(reduced.starts_matrix, cross.transpose(0, 2, 1))
    right = np.linalg.solve(reduced.starts_matrix, reduced.starts_vector[..., None])[..., 0]
    matrix = d @ d.transpose(0, 2, 1) - cross @ solved
    vector = np.einsum("whl,wl->wh", d, linear.residual) - np.einsum("whs,ws->wh", cross, right)
    J = linear.columns.transpose(1, 0, 2)
    return Grams(
        matrix, vector, d @ J.transpose(0, 2, 1) - solved.transpose(0, 2, 1) @ reduced.cross.transpose(0, 2, 1)
    )


def _pseudo(name: str, hook: str, function: Any, constants: tuple[float, ...]) -> Cause:
    return Cause(
        name=name, title=name, acts_on="", parameters=(), source=Source("assumed"), order=8,
        pack=lambda setup, values, own: (0.0, *constants), **{hook: function},
    )  # fmt: skip


def _basis(values: Float, knots: Float) -> Float:
    """Hats over the knots, [w, h, k]; zero where a value is missing."""
    step = knots[1] - knots[0]
    place = np.clip((np.nan_to_num(values) - knots[0]) / step, 0, len(knots) - 1)
    heights: Float = np.maximum(0.0, 1.0 - np.abs(place[..., None] - np.arange(len(knots))))
    heights[np.isnan(values)] = 0.0
    return heights


def _function(
    place: str, variable: str, signed: bool, grams: Grams, values: Mapping[str, Float], inverse: Float, vector: Float
) -> Term:
    v = values[variable]
    low, high = np.nanquantile(v, [0.003, 0.997])
    best = Term(place, variable, signed, -np.inf, np.zeros(0), np.zeros(0), np.zeros(0))
    if not high - low > 1e-9 * max(abs(low), abs(high), 1e-3):
        return best
    for count in (*KNOTS, *FINER) if variable in POSITIONS else KNOTS:
        knots = np.linspace(low, high, count)
        phi = _basis(v, knots)
        if signed:
            phi = phi * -np.nan_to_num(values["speed sign"])[..., None]
        M, b = _normal(grams, phi, inverse, vector)
        if not np.trace(M) > 0.0:
            continue
        M = M + 1e-4 * np.trace(M) / count * np.eye(count)
        y = np.linalg.solve(M, b)
        gain = float(b @ y) - PRICE * count
        if gain > best.gain:
            std = np.sqrt(np.maximum(np.diag(np.linalg.inv(M)), 0.0))
            best = replace(best, gain=gain, x=knots, y=y, std=std)
    return best


def _normal(grams: Grams, phi: Float, inverse: Float, vector: Float) -> tuple[Float, Float]:
    """Normal equations of a function's heights, globals eliminated."""
    M = np.einsum("whk,whl->kl", phi, grams.matrix @ phi)
    b = np.einsum("whk,wh->k", phi, grams.vector)
    C = np.einsum("whk,whp->kp", phi, grams.cross)
    return M - C @ inverse @ C.T, b - C @ inverse @ vector


def _sinusoid(problem: Problem, place: str, grams: Grams, at: Float) -> Term:
    """A vibration of one frequency, its phase and size each run's own."""
    frequencies = np.arange(2.0, 62.0, 0.05)
    gains, amplitude = np.zeros(len(frequencies)), np.zeros(len(frequencies))
    for first in range(0, len(frequencies), AT_ONCE):
        some = slice(first, first + AT_ONCE)
        phase = 2 * np.pi * frequencies[some, None, None] * at
        phi = np.stack([np.cos(phase), np.sin(phase)], axis=-1)
        each = phi.swapaxes(2, 3) @ (grams.matrix @ phi)
        b = (phi * grams.vector[..., None]).sum(axis=2)
        for run in range(len(problem.runs)):
            mine = problem.windows.run == run
            if mine.any():
                right = b[:, mine].sum(axis=1)
                y = np.linalg.solve(each[:, mine].sum(axis=1) + 1e-9 * np.eye(2), right[..., None])[..., 0]
                gains[some] += np.sum(right * y, axis=1)
                amplitude[some] += np.hypot(y[:, 0], y[:, 1]) / len(problem.runs)
    best = int(np.argmax(gains))
    gain = float(gains[best]) - PRICE * (2 * len(problem.runs) + 4)
    f = float(frequencies[best])
    x = np.linspace(0, 1 / f, 21)
    return Term(place, "frequency", False, gain, x, amplitude[best] * np.cos(2 * np.pi * f * x), 0 * x, f)


SLOTS = {
    "time": 0,
    "weight_position": 1,
    "weight_velocity": 2,
    "pulley_angle": 3,
    "drive_position": 5,
    "drive_velocity": 6,
    "fibre_force": 18,
}
TABLES: Mapping[str, Any] = {
    "guide": kernels.guide_table, "pulley": kernels.rim_table, "dial-gauge": kernels.dial_table,
    "force-gauge": kernels.gauge_table, "drive": kernels.drive_table,
}  # fmt: skip


def as_cause(term: Term) -> Cause | None:
    """The term as a cause whose parameters are its heights; None where no hook can carry it."""
    if term.place not in TABLES or term.variable not in SLOTS or term.frequency is not None:
        return None
    kind = (200.0 if term.signed else 100.0) + SLOTS[term.variable]
    head = (kind, float(term.x[0]), float(term.x[1] - term.x[0]), float(len(term.x)))
    unit = PLACES[term.place][3]
    size = float(np.max(np.abs(term.y))) or 1.0
    return Cause(
        name="unknown", title="a term outside the catalogue", acts_on=term.place,
        parameters=tuple(Parameter(f"y{i}", unit, 0.0, uncertainty=size) for i in range(len(term.x))),
        source=Source("learned"), order=8, **{PLACES[term.place][0]: TABLES[term.place]},
        pack=lambda setup, values, own: (0.0, *head, *values.values()),
    )  # fmt: skip
