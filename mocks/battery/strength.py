"""How strongly a hidden effect shows: sqrt(delta chi^2 / N) over short windows, after a linear refit.

The plain stand is restarted in short windows from the measured state of one that hides something; starts and base
parameters are refitted to first order within their priors; what is left, in units of the sensors' noise, is the
effect's strength, in its strongest channel.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocks.effects import Value
from mocks.plant import march
from mocks.plant.forces import S, U, V, W
from mocks.plant.motion import Motion, targets
from mocks.plant.operator import Stand
from mocks.plant.plant import GRID, Plant, Slice
from mocks.plant.world import World

Float = NDArray[np.float64]

WINDOW, THIN = 120, 10  # samples a window, grid steps a sample
NOISE = np.array([6e-6, 0.12])
START_PRIOR = {U: 7.5e-6, V: 7.5e-3, S: 15e-6, W: 30e-3}
BASE = {  # what calibration may move, and by which share
    "c": 0.05,
    "b": 0.10,
    "mass": 0.01,
    "friction": 0.10,
    "rim_mass": 0.10,
    "gravity_along": 0.01,
    "friction_velocity": 0.10,
    "share1": 0.01,
}
TAUT, CLEAR = 4.0, 16  # N above which the fibre pulls well, samples around a start for which it must


@dataclass(frozen=True)
class Window:
    """Residual and sensitivities of one window in units of noise: r [2 WINDOW], starts [.., 4], base [.., 8]."""

    r: Float
    starts: Float
    base: Float


def strength(
    stand: Stand,
    hidden: Mapping[str, Mapping[str, Value]],
    motions: Sequence[Motion],
    seconds: float = 7.5,
    windows: int = 8,
) -> float:
    """Strength of what is hidden in runs of these motions, `windows` of them in each; noise-free, operator exact."""
    cut = [
        w
        for motion in motions
        for w in run_windows(stand.with_mass(motion.added_mass), hidden, motion, seconds, windows)
    ]
    left = np.stack(refit(cut))
    chi = (left.reshape(len(cut), 2, WINDOW) ** 2).mean(axis=(0, 2))
    return float(np.sqrt(chi.max()))


def run_windows(
    stand: Stand, hidden: Mapping[str, Mapping[str, Value]], motion: Motion, seconds: float, windows: int
) -> list[Window]:
    """Windows spread over the taut stretches of one run."""
    plant = Plant(stand.believed, hidden)
    run = plant.follow(targets(motion, seconds, GRID))
    run = _by_clocks(run, plant.world)
    starts = _taut(run.F[::THIN])
    chosen = starts[np.linspace(0, len(starts) - 1, windows).astype(int)] if len(starts) else []
    return [_window(stand, run, int(k) * THIN) for k in chosen]


def _by_clocks(run: Slice, world: World) -> Slice:
    """The run as its instruments date it."""

    def dated(signal: Float, instrument: str) -> Float:
        return np.interp(run.time / (1.0 + world.clocks.get(instrument, 0.0)), run.time, signal)

    if not world.clocks:
        return run
    return Slice(run.time, dated(run.x, "drive"), dated(run.u, "dial_gauge"), dated(run.F, "force_gauge"), run.truth)


def _taut(force: Float) -> NDArray[np.int64]:
    """Samples at which a window may start: moving or held, the fibre taut around them, the first rest over."""
    low = np.lib.stride_tricks.sliding_window_view(force, 2 * CLEAR + 1).min(axis=1) > TAUT
    at = np.flatnonzero(low) + CLEAR
    return at[(at > 1950) & (at < len(force) - WINDOW - 2000 + 1)]


def _window(stand: Stand, run: Slice, first: int) -> Window:
    base = World.of(stand.believed, {}).record()
    path = np.stack([run.x, np.gradient(run.x, GRID)], axis=-1)[first : first + WINDOW * THIN + 1]
    y = march.rest_state(World.of(stand.believed, {}).physics)
    y[[U, V, S, W]] = _reconstruct(run, base[0], first, path[0])
    measured = np.concatenate([s[first : first + WINDOW * THIN + 1 : THIN][1:] for s in (run.u, run.F)])
    plain = _simulate(base, y, path)
    sigma = np.repeat(NOISE, WINDOW)
    starts = [(_simulate(base, _moved(y, i, 0.1 * p), path) - plain) / (0.1 * sigma) for i, p in START_PRIOR.items()]
    bases = [(_simulate(_scaled(base, n, 0.1 * p), y, path) - plain) / (0.1 * sigma) for n, p in BASE.items()]
    return Window((measured - plain) / sigma, np.stack(starts, axis=-1), np.stack(bases, axis=-1))


def _reconstruct(run: Slice, p: np.void, first: int, drive: Float) -> Float:
    """u, u', s, s' from u, x and F around a sample."""
    near = slice(first - 60, first + 61)
    t = (np.arange(121) - 60.0) * GRID
    u, v = np.polyfit(t, run.u[near], 2)[[2, 1]]
    pull = np.polyfit(t, run.F[near] - p["rest_tension"], 2)
    stiff = float(p["c"] * p["share2"])
    return np.array([u, v, drive[0] - pull[2] / stiff, drive[1] - pull[1] / stiff])


def _simulate(record: NDArray[np.void], y: Float, path: Float) -> Float:
    """u and F of the plain stand at the window's samples."""
    state, out = y.copy(), np.empty((len(path) - 1, len(march.COLUMNS)))
    contacts, none = np.array([True, True, False, False]), np.zeros((4, 7201))
    bristles = np.array([np.tanh(y[V] / record["friction_velocity"][0]), 0.0, 0.0, 0.0])
    march.march(0.0, state, bristles, contacts, path, GRID, record, none, 4, out)
    return np.concatenate([out[THIN - 1 :: THIN, 2], out[THIN - 1 :: THIN, 6]])


def _moved(y: Float, index: int, by: float) -> Float:
    moved = y.copy()
    moved[index] += by
    return moved


def _scaled(record: NDArray[np.void], name: str, share: float) -> NDArray[np.void]:
    changed = record.copy()
    changed[name] *= 1.0 + share
    return changed


def refit(cut: Sequence[Window]) -> list[Float]:
    """Residuals after starts (each window's own) and base parameters (common) have moved, priors of one unit each."""
    number = cut[0].base.shape[1]
    H, g = np.eye(number), np.zeros(number)
    for w in cut:
        inverse, cross = np.linalg.inv(w.starts.T @ w.starts + np.eye(4)), w.starts.T @ w.base
        H += w.base.T @ w.base - cross.T @ inverse @ cross
        g += w.base.T @ w.r - cross.T @ inverse @ (w.starts.T @ w.r)
    move = np.linalg.solve(H, g)
    left = []
    for w in cut:
        r = w.r - w.base @ move
        left.append(r - w.starts @ np.linalg.solve(w.starts.T @ w.starts + np.eye(4), w.starts.T @ r))
    return left
