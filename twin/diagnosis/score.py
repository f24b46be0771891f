"""How much each cause, at each trial of what is nonlinear in it, would explain to first order."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.causes._kind import Cause, Survey
from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import FLOOR, Fitted, linearise, reduce, scale, weigh
from twin.diagnosis.problem import Problem

Float = NDArray[np.float64]
VISIBLE = 0.01


@dataclass(frozen=True)
class Scored:
    """A cause at its trials, best first: each (gain in weighted squares, amplitude, values).

    smallest: of its first parameter, from null, that would be seen; None where no trial shows anything.
    """

    cause: Cause
    trials: tuple[tuple[float, float, Mapping[str, float]], ...]
    smallest: float | None = None

    @property
    def gain(self) -> float:
        """The best trial's."""
        return self.trials[0][0] if self.trials else 0.0


def survey(problem: Problem) -> Survey:
    """What the runs reach."""
    runs = problem.runs

    def reach(name: str) -> tuple[float, float]:
        return min(float(getattr(r, name).min()) for r in runs), max(float(getattr(r, name).max()) for r in runs)

    return Survey(
        u=reach("raw_u"), x=reach("raw_x"), F=reach("raw_F"),
        speed=max(float(np.abs(r.u.rate).max()) for r in runs), seconds=max(r.seconds for r in runs),
        noise_u=runs[0].noise_u, noise_F=runs[0].noise_F,
    )  # fmt: skip


def score(problem: Problem, fitted: Fitted, causes: Iterable[Cause], *, share: float = 0.5) -> list[Scored]:
    """All causes, best first. Base values (with their priors) and the windows' starts are projected out."""
    spread = scale(problem, fitted.residual)
    free = np.ones(len(fitted.z), bool)
    linear = linearise(problem, fitted, spread, free)
    reduced = reduce(linear, fitted.starts, fitted.z)
    own = linear.starts.transpose(1, 0, 2)
    root = np.sqrt(weigh(fitted.residual, spread)) / spread * problem.windows.use
    simulated, _ = problem.simulate(fitted.model, fitted.z, fitted.starts)
    here = problem.sense(fitted.model, fitted.z, simulated)
    inverse = np.linalg.pinv(reduced.matrix, rcond=1e-12)
    reach = survey(problem)
    enough = max(25.0, VISIBLE * float(np.sum(problem.windows.use)) / 2)
    powers: list[tuple[float, float]] = []

    def one(cause: Cause, values: Mapping[str, float]) -> tuple[float, float, Mapping[str, float]]:
        model = Composition(fitted.model.setups, (*fitted.model.causes, cause))
        z = model.put(fitted.model.carry(fitted.z, model), cause, values)
        if cause.senses is not None and cause.before is None and cause.after is None:
            there = problem.sense(model, z, simulated)
        else:
            there = problem.predict(model, z, fitted.starts)
        d = np.nan_to_num(np.clip(there - here, -1.0, 1e4) * root).reshape(len(there), -1)
        gain, amplitude, power = _gain(d, linear.columns, own, linear.residual, reduced, inverse)
        size = values[cause.parameters[0].name] - cause.parameters[0].value
        powers.append((power / max(size * size, 1e-300), abs(size)))
        return gain, amplitude, values

    found = []
    for cause in causes:
        if cause.base is not None:
            found.append(_freed(cause, fitted, reduced))
            continue
        powers: list[tuple[float, float]] = []
        trials = [_within(cause, one(cause, v)) for v in cause.trials(reach)]
        found.append(Scored(cause, tuple(sorted(trials, key=lambda t: -t[0])), _smallest(cause, powers, enough)))
    return sorted(found, key=lambda s: -s.gain)


def _gain(d, J, own, r, reduced, inverse):  # type: ignore[no-untyped-def]
    """Gain, amplitude and power along d with starts and globals refitted linearly."""
    cross = np.einsum("wsl,wl->ws", own, d)
    with_starts = np.linalg.solve(reduced.starts_matrix, np.stack([cross, reduced.starts_vector], axis=-1))
    dd = float(np.sum(d * d) - np.sum(cross * with_starts[..., 0]))
    dr = float(np.sum(d * r) - np.sum(cross * with_starts[..., 1]))
    Jd = np.einsum("pwl,wl->p", J, d) - np.einsum("wps,ws->p", reduced.cross, with_starts[..., 0])
    dd -= float(Jd @ inverse @ Jd)
    dr -= float(Jd @ inverse @ reduced.vector)
    if dd <= 1e-9:
        return 0.0, 0.0, 0.0
    return dr * dr / dd, dr / dd, dd


def _smallest(cause: Cause, powers: list[tuple[float, float]], enough: float) -> float | None:
    """The size whose effect would be `enough` squares, where the effect grows with the size."""
    best = max((p for p, _ in powers), default=0.0)
    first = cause.parameters[0]
    grows = abs(first.value) < 1e3 and first.name not in ("position", "friction")
    return float(np.sqrt(enough / best)) if grows and best > 0 else None


def _within(cause: Cause, trial: tuple[float, float, Mapping[str, float]]) -> tuple[float, float, Mapping[str, float]]:
    """The amplitude kept on the side, and for what is not linear in it near the size, that was tried."""
    gain, amplitude, values = trial
    first = cause.parameters[0]
    low, high = first.bounds
    size = values[first.name] - first.value
    tried = first.value + amplitude * size
    most = 4.0 if cause.scan is None or len(values) > 1 else 1.5
    kept = float(np.clip(amplitude, -most if low <= first.value - abs(size) else 0.0, most))
    if not low <= tried <= high and not low <= first.value + kept * size <= high:
        kept = 0.0
    share = kept / amplitude if amplitude else 0.0
    return gain * max(0.0, share * (2.0 - share)), kept, values


def _freed(cause: Cause, fitted: Fitted, reduced) -> Scored:  # type: ignore[no-untyped-def]
    """A base value without its prior: the gain of letting it go where the data pull it."""
    i = fitted.model.index.get(("base", str(cause.base)))
    if i is None:
        return Scored(cause, ())
    c = fitted.model.coordinates[i]
    matrix, vector = reduced.matrix.copy(), reduced.vector.copy()
    matrix[i, i] -= 1.0 / c.prior**2
    vector[i] += fitted.z[i] / c.prior**2
    old = np.linalg.pinv(reduced.matrix, rcond=1e-12)
    inside = np.ones(len(vector), bool)
    for j, other in enumerate(fitted.model.coordinates):
        inside[j] = j == i or other.low + 1e-6 < fitted.z[j] < other.high - 1e-6
    free = np.ix_(inside, inside)
    step = np.zeros(len(vector))
    step[inside] = np.linalg.lstsq(matrix[free], vector[inside], rcond=1e-12)[0]
    gain = float(vector @ step) - float(reduced.vector @ old @ reduced.vector) * 0.0
    value = c.value(float(fitted.z[i] + step[i]))
    error = float(np.sqrt(np.linalg.pinv(matrix)[i, i]))
    smallest = 3.0 * c.scale * float(np.hypot(1.0 if np.isinf(c.prior) else c.prior, error))
    return Scored(cause, ((max(gain, 0.0), 1.0, {"difference": value}),), smallest)


__all__ = ["FLOOR", "Scored", "score", "survey"]
