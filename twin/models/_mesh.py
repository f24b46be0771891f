"""Elements' lengths: fine where the fibre meets the pulley, coarse in the strands; and rest before a run."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from stand.setup import Setup
from twin.kernels.fibre_layout import DRAG, DRY, LENGTH, MASS, RADIUS, RIM, WEIGHT
from twin.model import Start

Float = NDArray[np.float64]
Advance = Callable[[Float, Float, Float, float, Float], int]

MARGIN = 0.003  # m of fine elements on either side of arc and stroke
_SAMPLES, _DRAG, _STEP = 100, 300.0, 1e-3  # of the rest: ms, 1/s, s


def mesh(c: Float, setup: Setup, stroke: float, elements: int, fine: int) -> Float:
    """Lengths [elements], m: `fine` of them over the arc and the stroke; all alike where there is no pulley."""
    length = float(c[LENGTH])
    if c[RADIUS] == 0.0:
        return np.full(elements, length / elements)
    first = max(setup.weight_strand_length - stroke - MARGIN, 0.1 * setup.weight_strand_length)
    arc = setup.pulley_radius * setup.wrap_angle
    last = min(setup.weight_strand_length + arc + MARGIN, length - 0.1 * setup.drive_strand_length)
    fine = min(fine, elements - 2)
    left = max(1, min(elements - fine - 1, round((elements - fine) / 2)))
    parts = ((first, left), (last - first, fine), (length - last, elements - fine - left))
    return np.concatenate([np.full(n, size / n) for size, n in parts])


def rest(advance: Advance, c: Float, state: Float, start: Start, step: int) -> None:
    """Let the fibre find its shape while weight, drive and, where it is known, the pulley are held.

    step: the place of the longest step in `c`.
    """
    held = c.copy()
    held[MASS], held[WEIGHT], held[DRY], held[DRAG], held[step] = 1e9, 0.0, 0.0, _DRAG, _STEP
    if start.s is not None or start.force is not None:
        held[RIM] = 1e9
    _settle(advance, held, state, start)
    state[0] = start.u


def trimmed(advance: Advance, laid: Callable[[Float], Float], c: Float, first: int, step: int) -> Float:
    """The fibre made longer (its first element, `c[first]`) until the weight rests at u = 0.

    laid(c): the state of a fibre laid on its path.
    """
    loose = c.copy()
    loose[MASS], loose[DRY], loose[DRAG], loose[step] = 0.02, 0.0, _DRAG, _STEP
    for _ in range(3):
        state = laid(loose)
        _settle(advance, loose, state, Start())
        loose[first] += state[0]
    trim = c.copy()
    trim[first] = loose[first]
    return trim


def _settle(advance: Advance, c: Float, state: Float, start: Start) -> None:
    drive = np.zeros((_SAMPLES + 1, 2))
    drive[:, 0] = start.x
    if advance(c, state, drive, 1e-3, np.empty((_SAMPLES, 3))) != 0:
        raise RuntimeError("the fibre finds no shape on the pulley at rest")
