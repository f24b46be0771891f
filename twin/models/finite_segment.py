"""Finite segments: rigid elements joined by joint springs, with contact and friction on the pulley (S0, section 2)."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from stand.setup import Setup, System
from twin.friction import packed
from twin.kernels import fibre_segment_layout as layout
from twin.kernels.fibre_layout import LENGTH, RADIUS, RIG, pack_rig
from twin.kernels.fibre_order import memory
from twin.model import FibreModel, Float, Start
from twin.models._mesh import mesh, rest, trimmed
from twin.models._place import Placed, place
from twin.parameter import Parameter, Source

_PARAMETERS = (
    Parameter("segments", "-", 60.0, (4.0, 2000.0), None, "number of rigid segments"),
    Parameter("fine_segments", "-", 48.0, (2.0, 2000.0), None, "how many of them cover the arc and the stroke"),
    Parameter("bending_stiffness", "N*m^2", 1e-4, (0.0, 1.0), 1e-4, "EI; its solid section would have 5.2e-3"),
    Parameter("pulley_friction", "-", 0.3, (0.0, 2.0), 0.1, "between fibre and rim"),
    Parameter("contact_stiffness", "N/m^2", 1e8, (1e6, 1e12), None, "pressure per depth into the rim"),
    Parameter("bristle_stiffness", "N/m^2", 3e7, (0.0, 1e12), None, "friction per slip while it sticks"),
    Parameter("stroke", "m", 0.09, (0.0, 1.0), None, "length of fibre that may run onto the pulley"),
    Parameter("fibre_drag", "1/s", 0.0, (0.0, 100.0), None, "mass-proportional damping"),
    Parameter("step", "s", 5e-4, (1e-6, 1e-2), None, "longest step of the integrator"),
)
_POINTS = 6  # contact points of a segment


def _constants(setup: Setup, parameters: Mapping[str, float]) -> Float:
    segments, fine, bending, friction, contact, bristle, stroke, drag, step = packed(_PARAMETERS, parameters)
    count = round(segments)
    c = pack_rig(setup, layout.OWN + count, sliding=friction, drag=drag)
    lengths = RIG + layout.OWN
    c[RIG:lengths] = [count, _POINTS, bending, contact, bristle, step, lengths]
    c[lengths : lengths + count] = mesh(c, setup, stroke, count, round(fine))
    return trimmed(_advance, lambda loose: _laid(loose, Start()), c, lengths, layout.STEP) if c[RADIUS] > 0.0 else c


def _placed(c: Float, start: Start) -> tuple[Placed, Placed]:
    """The fibre at the ends of all segments and at their middles."""
    count, at = int(c[layout.SEGMENTS]), int(c[layout.LENGTHS])
    ends = np.concatenate([[0.0], np.cumsum(c[at : at + count])])
    ends *= c[LENGTH] / ends[-1]
    return place(c, start, ends), place(c, start, (ends[1:] + ends[:-1]) / 2)


def _laid(c: Float, start: Start) -> Float:
    """The state of a fibre laid on its path, everything at rest."""
    count, n = int(c[layout.SEGMENTS]), 3 * int(c[layout.SEGMENTS]) + 2
    ends, middles = _placed(c, start)
    d = np.diff(ends.points, axis=0)
    angle = np.unwrap(np.arctan2(d[:, 1], d[:, 0]))
    bodies = np.column_stack([middles.points, angle]).reshape(-1)
    return np.concatenate(
        [
            [start.u, 0.0],
            bodies,
            [middles.s],
            np.zeros(2 * n - 1 + count * _POINTS + memory(n, layout.BAND, count * _POINTS, 2)),
        ]
    )


def _start(c: Float, start: Start) -> Float:
    count, state = int(c[layout.SEGMENTS]), _laid(c, start)
    n = 3 * count + 2
    rest(_advance, c, state, start, layout.STEP)
    ends, middles = _placed(c, start)
    d, e = np.diff(ends.points, axis=0), np.diff(ends.velocities, axis=0)
    turn = (d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]) / (d[:, 0] ** 2 + d[:, 1] ** 2)
    speeds = np.column_stack([middles.velocities, turn]).reshape(-1)
    state[1], state[1 + n : 2 * n] = start.v, np.concatenate([speeds, [middles.rim_speed]])
    state[2 * n : 3 * n] = 0.0
    state[-memory(n, layout.BAND, count * _POINTS, 2) :] = 0.0
    return state


def _advance(c: Float, state: Float, drive: Float, dt: float, out: Float) -> int:
    from twin.kernels import fibre_segment, fibre_step

    count, at = int(c[layout.SEGMENTS]), int(c[layout.LENGTHS])
    steps = max(1, math.ceil(dt / c[layout.STEP] - 1e-6))
    size = np.array([3 * count + 2, layout.BAND, count * _POINTS, steps, 2], dtype=np.int64)
    ones = np.ones(count)
    norm = np.concatenate([[1.0], np.column_stack([ones, ones, c[at : at + count] / 4]).reshape(-1), [1.0]])
    return int(fibre_step.advance(fibre_segment.assemble, fibre_segment.gauge, size, norm, c, state, drive, dt, out))


def _warm() -> None:
    from twin.kernels import fibre_segment  # noqa: F401


MODEL = FibreModel(
    name="finite-segment",
    title="Finite segments",
    source=Source("Wittbrodt, Adamiec-Wojcik, Wojciech", 2006, "chapter 2; Shabana 1997"),
    systems=frozenset({System.WFPD, System.WF}),
    parameters=_PARAMETERS,
    state=("u", "u'", "segments' positions and angles", "s", "their rates", "s'", "accelerations", "bristles"),
    constants=_constants,
    start=_start,
    advance=_advance,
    warm=_warm,
)
