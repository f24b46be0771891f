"""The four force models' shared functions: constants, start, advance, warm."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from stand.setup import Setup
from twin.kernels.force_layout import ALONG, B2, C1, C2, OFFSET, REST, RIM, STATE, TIGHT, pack
from twin.model import Start

Float = NDArray[np.float64]


def constants(setup: Setup, parameters: Mapping[str, float]) -> Float:
    """The kernel's constants; `parameters`: threshold, damping_slope, stiffness_slope, signed, tolerance."""
    return pack(
        setup,
        threshold=parameters.get("threshold", math.inf),
        damping_slope=parameters.get("damping_slope", 0.0),
        stiffness_slope=parameters.get("stiffness_slope", 0.0),
        signed=parameters.get("signed", 0.0) != 0.0,
        tolerance=parameters.get("tolerance", TIGHT),
    )


def start(k: Float, at: Start) -> Float:
    """The state at a measured instant: the rim from F where known (else from x and u alone), strands as they are.

    A slack drive strand says nothing of the rim: it is then placed where both strands' stretches are alike.
    """
    from twin.kernels.force import settle

    state = np.zeros(STATE)
    state[0], state[1] = at.u, at.v
    if k[RIM] > 0.0:
        state[2], state[3] = _rim(k, at)
    settle(k, state, at.x, at.w)
    return state


def _rim(k: Float, at: Start) -> tuple[float, float]:
    """s and s': as given, or from T2 = F, or balancing both strands (S1's layout, `stand.md`)."""
    balance, speed = _balance(k, _near(k, at.u), at.x), _balance(k, _cosine(k, at.u) * at.v, at.w)
    if at.rim_speed is not None:
        speed = at.rim_speed
    if at.s is not None:
        return at.s, speed
    if at.force is not None and at.force > 0.0:
        return float(at.x + (k[REST] + k[B2] * (at.w - speed) - at.force) / k[C2]), speed
    return balance, speed


def _near(k: Float, u: float) -> float:
    """How much shorter than at rest the weight's strand is, m."""
    return u if k[OFFSET] == 0.0 else math.hypot(k[ALONG], k[OFFSET]) - math.hypot(k[ALONG] - u, k[OFFSET])


def _cosine(k: Float, u: float) -> float:
    return 1.0 if k[OFFSET] == 0.0 else float(k[ALONG] - u) / math.hypot(k[ALONG] - u, k[OFFSET])


def _balance(k: Float, near: float, far: float) -> float:
    """Where the rim rests between weight and drive: c1 (s - u) = c2 (x - s)."""
    return float((k[C1] * near + k[C2] * far) / (k[C1] + k[C2]))


def advance(k: Float, state: Float, drive: Float, dt: float, out: Float) -> int:
    """Carries the state over the drive's samples; see `FibreModel`."""
    from twin.kernels.force import advance as kernel

    return int(kernel(k, state, drive, dt, out))


def warm() -> None:
    """Loads the kernel, compiling it where the cache is empty."""
    import twin.kernels.force  # noqa: F401


NAMES = ("u", "u'", "s", "s'", "strand 1 taut", "strand 2 taut", "beyond the threshold")
