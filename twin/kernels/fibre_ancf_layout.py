"""What the ANCF kernel's constants hold behind the rig's, and the shape functions at its points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from twin.kernels.fibre_layout import RIG

Float = NDArray[np.float64]

ELEMENTS, POINTS, EI, CONTACT, SHEAR, STEP, LENGTHS, SHAPES, EVEN, ORDER = range(RIG, RIG + 10)
OWN = 10
GAUSS = 3  # axial points of an element: exact for the mean of its quartic strain
BAND = 7


def shape(part: Float) -> Float:
    """Cubic Hermite functions at `part` (0 to 1) of a unit element, [n, 4]; the 2nd and 4th times its length."""
    p = part
    return np.stack([1 - 3 * p**2 + 2 * p**3, p - 2 * p**2 + p**3, 3 * p**2 - 2 * p**3, p**3 - p**2], axis=1)


def shape_slope(part: Float) -> Float:
    """Their derivatives over `part`, [n, 4]."""
    p = part
    return np.stack([6 * p**2 - 6 * p, 1 - 4 * p + 3 * p**2, 6 * p - 6 * p**2, 3 * p**2 - 2 * p], axis=1)


def tables(points: int) -> Float:
    """Axial points: weight and slopes [3, 5]; evenly spaced contact points: values [points, 4]; in one row."""
    at, weight = np.polynomial.legendre.leggauss(GAUSS)
    axial = np.concatenate([weight[:, None] / 2, shape_slope((at + 1) / 2)], axis=1)
    contact = shape((np.arange(points) + 0.5) / points)
    return np.concatenate([axial.reshape(-1), contact.reshape(-1)])
