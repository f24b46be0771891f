"""How much each cause, at each trial of what is nonlinear in it, would explain to first order."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from twin.causes._kind import Cause, Survey, no_undo
from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import FLOOR, Fitted, scale, weigh
from twin.diagnosis.normal import Linear, reduce
from twin.diagnosis.problem import Problem

Float = NDArray[np.floating[Any]]
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

    often = np.quantile(np.concatenate([r.raw_u for r in runs]), [0.05, 0.95])
    return Survey(
        u=reach("raw_u"), often=(float(often[0]), float(often[1])), x=reach("raw_x"), F=reach("raw_F"),
        speed=max(float(np.abs(r.u.rate).max()) for r in runs), seconds=max(r.seconds for r in runs),
        noise_u=runs[0].noise_u, noise_F=runs[0].noise_F,
    )  # fmt: skip


def score(problem: Problem, fitted: Fitted, causes: Iterable[Cause], linear: Linear) -> list[Scored]:
    """All causes, best first. Base values (with their priors) and the windows' starts are projected out; linear: the
    fit's `slopes`.
    """
    spread = scale(problem, fitted.residual)
    reduced = reduce(linear, fitted.starts, fitted.z)
    own = linear.starts.transpose(1, 0, 2)
    root = np.sqrt(weigh(fitted.residual, spread)) / spread * problem.windows.use
    simulated, _ = problem.simulate(fitted.model, fitted.z, fitted.starts)
    here = problem.sense(fitted.model, fitted.z, simulated)
    inverse = np.linalg.pinv(reduced.matrix, rcond=1e-12)
    low, high = fitted.model.low, fitted.model.high
    calm = bounded(reduced.matrix, reduced.vector, fitted.z, low, high)
    already = float(2 * reduced.vector @ calm - calm @ reduced.matrix @ calm)
    reach = survey(problem)
    powers: list[tuple[float, float]] = []
    enough = max(25.0, VISIBLE * float(np.sum(problem.windows.use)) / 2)

    def one(cause: Cause, values: Mapping[str, float]) -> tuple[float, float, Mapping[str, float]]:
        model = Composition(fitted.model.setups, (*fitted.model.causes, cause))
        z = model.put(fitted.model.carry(fitted.z, model), cause, values)
        if cause.undo is no_undo and cause.senses is not None and cause.before is None and cause.after is None:
            there = problem.sense(model, z, simulated)
        else:
            there = problem.predict(model, z, fitted.starts)
        d = np.nan_to_num(np.clip(there - here, -1.0, 1e4) * root).reshape(len(there), -1)
        box = (fitted.z, low, high, _most(cause, values), already)
        gain, amplitude, power = _gain(d, linear.columns, own, linear.residual, reduced, inverse, box)
        size = values[cause.parameters[0].name] - cause.parameters[0].value
        powers.append((power / max(size * size, 1e-300), abs(size)))
        return gain, amplitude, values

    found = []
    for cause in causes:
        if cause.base is not None:
            found.append(_freed(cause, fitted, reduced, low, high, already))
            continue
        powers.clear()
        trials = [one(cause, v) for v in cause.trials(reach)]
        found.append(Scored(cause, tuple(sorted(trials, key=lambda t: -t[0])), _smallest(cause, powers, enough)))
    return sorted(found, key=lambda s: -s.gain)


def _gain(
    d: Float, J: Float, own: Float, r: Float, reduced: Any, inverse: Float, box: Any
) -> tuple[float, float, float]:  # type: ignore[no-untyped-def]
    """Gain and amplitude along d, starts and globals refitted linearly within their bounds; its power besides."""
    cross = np.einsum("wsl,wl->ws", own, d)
    with_starts = np.linalg.solve(reduced.starts_matrix, np.stack([cross, reduced.starts_vector], axis=-1))
    dd = float(np.sum(d * d) - np.sum(cross * with_starts[..., 0]))
    dr = float(np.sum(d * r) - np.sum(cross * with_starts[..., 1]))
    Jd = np.einsum("pwl,wl->p", J, d) - np.einsum("wps,ws->p", reduced.cross, with_starts[..., 0])
    power = dd - float(Jd @ inverse @ Jd)
    if power <= 1e-9:
        return 0.0, 0.0, 0.0
    z, low, high, most, already = box
    H = np.block([[reduced.matrix, Jd[:, None]], [Jd[None, :], np.array([[dd]])]])
    g = np.append(reduced.vector, dr)
    step = bounded(H, g, np.append(z, 0.0), np.append(low, most[0]), np.append(high, most[1]))
    return max(float(2 * g @ step - step @ H @ step) - already, 0.0), float(step[-1]), power


def bounded(H: Float, g: Float, z: Float, low: Float, high: Float) -> Float:
    """The step that minimises step H step / 2 - g step with z + step within its bounds (active set, a few rounds)."""
    step, held = np.zeros(len(z)), np.zeros(len(z), bool)
    for _ in range(8):
        open_ = ~held
        right = g[open_] - H[np.ix_(open_, held)] @ step[held]
        step[open_] = np.linalg.lstsq(H[np.ix_(open_, open_)], right, rcond=1e-13)[0]
        beyond = open_ & ((z + step < low - 1e-12) | (z + step > high + 1e-12))
        if not beyond.any():
            break
        step[beyond] = np.clip(z + step, low, high)[beyond] - z[beyond]
        held |= beyond
    return np.clip(z + step, low, high) - z


def _smallest(cause: Cause, powers: list[tuple[float, float]], enough: float) -> float | None:
    """The size whose effect would be `enough` squares, where the effect grows with the size."""
    best = max((p for p, _ in powers), default=0.0)
    first = cause.parameters[0]
    grows = abs(first.value) < 1e3 and first.name not in ("position", "friction")
    return float(np.sqrt(enough / best)) if grows and best > 0 else None


def _most(cause: Cause, values: Mapping[str, float]) -> tuple[float, float]:
    """How far an amplitude may go, in trials: on the side and near the size that was tried."""
    first = cause.parameters[0]
    size = values[first.name] - first.value
    far = 4.0 if cause.scan is None or len(values) > 1 else 1.5
    return (-far if first.bounds[0] <= first.value - abs(size) and first.bounds[1] > first.value else 0.0), far


def _freed(cause: Cause, fitted: Fitted, reduced, low, high, already) -> Scored:  # type: ignore[no-untyped-def]
    """A base value without its prior and bounds: the gain of letting it go where the data pull it."""
    i = fitted.model.index.get(("base", str(cause.base)))
    if i is None or np.isinf(fitted.model.coordinates[i].prior):
        return Scored(cause, ())
    c = fitted.model.coordinates[i]
    matrix, vector = reduced.matrix.copy(), reduced.vector.copy()
    matrix[i, i] -= 1.0 / c.prior**2
    vector[i] += fitted.z[i] / c.prior**2
    low, high = low.copy(), high.copy()
    low[i], high[i] = -60.0, 60.0
    step = bounded(matrix, vector, fitted.z, low, high)
    gain = float(2 * vector @ step - step @ matrix @ step) - already
    value = c.value(float(fitted.z[i] + step[i]))
    error = float(np.sqrt(max(np.linalg.pinv(matrix)[i, i], 0.0)))
    smallest = 3.0 * c.scale * float(np.hypot(c.prior, error))
    return Scored(cause, ((max(gain, 0.0), 1.0, {"difference": value}),), smallest)


__all__ = ["FLOOR", "Scored", "score", "survey"]
