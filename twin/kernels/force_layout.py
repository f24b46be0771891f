"""What the force kernel's constants and state hold, place by place."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stand.setup import Setup, System
from twin.rigs import rest_tension, strand

# constants
MASS, RIM, C1, B1, C2, B2, REST, WEIGHT, DRY, DRY_SPEED = range(10)
THRESHOLD, DAMPING_SLOPE, STIFFNESS_SLOPE, SIGNED, RATIO1, RATIO2, TOLERANCE, SLIDES, CREEPS = range(10, 19)
ALONG, OFFSET, NORMAL = range(19, 22)
CONSTANTS = 22
# state: u, u', s, s', whether each strand is taut, whether the threshold speed is passed
STATE = 7
#: a pulley lighter (J/r^2) than this share of the weight moves as if it had no mass
MASSLESS = 1e-6
#: largest last term of a series in m/s: the local error of a step
TIGHT = 1e-13


def pack(
    setup: Setup,
    *,
    threshold: float = math.inf,
    damping_slope: float = 0.0,
    stiffness_slope: float = 0.0,
    signed: bool = False,
    tolerance: float = TIGHT,
) -> NDArray[np.float64]:
    """The kernel's constants, float64 [22], of the force model (S1 eqs. 1 to 3 and `stand.md`'s balances).

    threshold m/s, damping_slope N s^2/m^2 and stiffness_slope N s/m^2 for the whole fibre; signed: the
    threshold is on u', not on its magnitude. A rig without a pulley, or whose pulley has no mass, is one strand.
    """
    k = np.zeros(CONSTANTS)
    rim = setup.pulley_inertia / setup.pulley_radius**2 if setup.system is System.WFPD else 0.0
    single = rim <= MASSLESS * setup.mass or setup.drive_strand_length <= 0
    length, first, second = setup.free_length, setup.weight_strand_length, setup.drive_strand_length
    k[RATIO1], k[RATIO2] = (1.0, 1.0) if single else (length / first, length / second)
    k[MASS], k[RIM] = setup.mass, 0.0 if single else rim
    k[C1], k[C2] = setup.fibre_stiffness * k[RATIO1], setup.fibre_stiffness * k[RATIO2]
    k[B1], k[B2] = setup.fibre_damping * k[RATIO1], setup.fibre_damping * k[RATIO2]
    path = strand(setup)
    k[ALONG], k[OFFSET] = path.along, path.offset
    k[NORMAL] = setup.mass * setup.gravity * math.cos(setup.incline_angle)
    k[REST], k[WEIGHT] = rest_tension(setup), setup.rest_tension
    k[DRY], k[DRY_SPEED] = setup.guide_friction, setup.guide_friction_velocity
    k[THRESHOLD], k[DAMPING_SLOPE], k[STIFFNESS_SLOPE] = threshold, damping_slope, stiffness_slope
    k[SIGNED], k[TOLERANCE] = float(signed), tolerance
    k[SLIDES], k[CREEPS] = _straight(setup.guide_friction / setup.mass, tolerance)
    return k


def _straight(deceleration: float, tolerance: float) -> tuple[float, float]:
    """|v|/v_s above which tanh is 1, and below which it is its argument, to `tolerance` in m/s over a millisecond.

    1 - tanh z = 2 exp(-2 z) and z - tanh z = z^3 / 3 to leading order; at rounding they are 19 and 4e-6.
    """
    change = max(1e-3 * deceleration, 1e-300)
    slides = 0.5 * math.log(max(2.0 * change / tolerance, 1.0))
    return min(max(slides, 2.0), 19.0), min(max((3.0 * tolerance / change) ** (1.0 / 3.0), 4e-6), 0.1)
