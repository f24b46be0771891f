"""What the Ritz kernel's constants hold behind the rig's: strands' lengths and the modes at its points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from twin.kernels.fibre_layout import RIG

STEP, FIRST, SECOND, ONSET, TABLE = range(RIG, RIG + 5)
AXIAL, TRANSVERSE, GAUSS = 3, 4, 8
MODES = AXIAL + TRANSVERSE
OWN = 5 + GAUSS * 10
BAND = 7

Float = NDArray[np.float64]


def modes(part: Float) -> tuple[Float, Float]:
    """Integrated Legendre polynomials, 0 at both ends, and their slopes over `part` (0 to 1), each [n, 4]."""
    x, p = 2 * part - 1, np.polynomial.legendre.Legendre.basis
    values = [(p(k + 1)(x) - p(k - 1)(x)) / np.sqrt(2 * (2 * k + 1)) for k in range(1, TRANSVERSE + 1)]
    slopes = [2 * np.sqrt((2 * k + 1) / 2) * p(k)(x) for k in range(1, TRANSVERSE + 1)]
    return np.stack(values, axis=-1), np.stack(slopes, axis=-1)


def table() -> Float:
    """part, weight, values [4], slopes [4] at every Gauss point, in one row."""
    at, weight = np.polynomial.legendre.leggauss(GAUSS)
    part = (at + 1) / 2
    values, slopes = modes(part)
    return np.column_stack([part, weight / 2, values, slopes]).reshape(-1)
