"""Normal equations of a fit over windows: every window's start eliminated, a damped step within bounds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]


@dataclass(frozen=True)
class Linear:
    """Weighted columns around a point: globals [p, w, 2 LENGTH], starts [4, w, 2 LENGTH], residual [w, 2 LENGTH]."""

    columns: Float
    starts: Float
    residual: Float
    prior: Float
    root: Float

    def part(self, keep: NDArray[np.intp]) -> Linear:
        """The same on some of the windows."""
        return Linear(self.columns[:, keep], self.starts[:, keep], self.residual[keep], self.prior, self.root[keep])


@dataclass(frozen=True)
class Reduced:
    """Normal equations of the globals after the starts' elimination; back: how starts follow a step."""

    matrix: Float
    vector: Float
    starts_matrix: Float
    starts_vector: Float
    cross: Float

    def follow(self, step: Float) -> Float:
        """The starts' step [w, 4] that goes with a step of the globals."""
        right = self.starts_vector - np.einsum("wps,p->ws", self.cross, step)
        return np.linalg.solve(self.starts_matrix, right[..., None])[..., 0]


def reduce(linear: Linear, starts: Float, z: Float) -> Reduced:
    """Schur complement over each window's start."""
    J, S, r = linear.columns, linear.starts, linear.residual
    own = S.transpose(1, 0, 2)
    matrix = own @ own.transpose(0, 2, 1) + np.eye(4)
    vector = np.einsum("wsl,wl->ws", own, r) - starts
    cross = J.transpose(1, 0, 2) @ own.transpose(0, 2, 1)
    solved = np.linalg.solve(matrix, np.concatenate([cross.transpose(0, 2, 1), vector[..., None]], axis=2))
    each = J.transpose(1, 0, 2)  # window by window: small products stay in one thread
    H = (each @ J.transpose(1, 2, 0)).sum(axis=0) - (cross @ solved[..., :-1]).sum(axis=0)
    g = np.einsum("pwl,wl->p", J, r) - np.einsum("wps,ws->p", cross, solved[..., -1])
    return Reduced(H + np.diag(linear.prior), g - linear.prior * z, matrix, vector, cross)


def solve(reduced: Reduced, z: Float, low: Float, high: Float, free: NDArray[np.bool_], damping: float) -> Float:
    """A damped step within bounds: coordinates that would leave them stop there and the others are solved again."""
    step = np.zeros(len(z))
    held = ~free
    for _ in range(4):
        open_ = ~held
        if not open_.any():
            break
        H = reduced.matrix[np.ix_(open_, open_)]
        H = H + damping * np.diag(np.diag(H)) + 1e-9 * np.eye(len(H))
        g = reduced.vector[open_] - reduced.matrix[np.ix_(open_, held)] @ step[held]
        step[open_] = np.linalg.lstsq(H, g, rcond=1e-12)[0]
        beyond = open_ & ((z + step < low - 1e-12) | (z + step > high + 1e-12))
        if not beyond.any():
            break
        step[beyond] = np.clip(z + step, low, high)[beyond] - z[beyond]
        held = held | beyond
    return np.clip(z + step, low, high) - z
