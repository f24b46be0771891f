"""Planar ANCF cable elements: large motion, axial and bending stiffness, contact with friction (S0, section 3.2)."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from stand.setup import Setup, System
from twin.friction import packed
from twin.kernels import fibre_ancf_layout as layout
from twin.kernels.fibre_layout import LENGTH, RADIUS, RIG, pack_rig
from twin.kernels.fibre_order import memory, order_of
from twin.model import FibreModel, Float, Start
from twin.models._mesh import mesh, rest, trimmed
from twin.models._place import Placed, place
from twin.parameter import Parameter, Source

_PARAMETERS = (
    Parameter("elements", "-", 18.0, (4.0, 2000.0), None, "number of elements"),
    Parameter("bending_stiffness", "N*m^2", 1e-4, (0.0, 1.0), 1e-4, "EI; its solid section would have 5.2e-3"),
    Parameter("pulley_friction", "-", 0.3, (0.0, 2.0), 0.1, "between fibre and rim"),
    Parameter("contact_stiffness", "N/m^2", 1e8, (1e6, 1e12), None, "pressure per depth into the rim"),
    Parameter("bristle_stiffness", "N/m^2", 3e7, (0.0, 1e12), None, "friction per slip while it sticks"),
    Parameter("stroke", "m", 0.09, (0.0, 1.0), None, "length of fibre that may run onto the pulley"),
    Parameter("fibre_drag", "1/s", 0.0, (0.0, 100.0), None, "mass-proportional damping"),
    Parameter("step", "s", 5e-4, (1e-6, 1e-2), None, "longest step of the integrator"),
    Parameter("fine_elements", "-", 14.0, (2.0, 2000.0), None, "how many of them cover the arc and the stroke"),
    Parameter("evenness", "-", 1e-4, (0.0, 1.0), None, "share of EA against uneven stretch within an element"),
    Parameter("order", "-", 2.0, (2.0, 4.0), None, "of the integrator: 2, or 4 where accuracy counts"),
)
_POINTS = 12  # contact points of an element


def _constants(setup: Setup, parameters: Mapping[str, float]) -> Float:
    elements, bending, friction, contact, bristle, stroke, drag, step, fine, evenness, order = packed(
        _PARAMETERS, parameters
    )
    count = round(elements)
    extra = count + 5 * layout.GAUSS + 4 * _POINTS
    c = pack_rig(setup, layout.OWN + extra, sliding=friction, drag=drag)
    lengths = RIG + layout.OWN
    c[RIG:lengths] = [
        count,
        _POINTS,
        bending,
        contact,
        bristle,
        step,
        lengths,
        lengths + count,
        evenness,
        order_of(order),
    ]
    c[lengths : lengths + count] = mesh(c, setup, stroke, count, round(fine))
    c[lengths + count : lengths + extra] = layout.tables(_POINTS)
    return trimmed(_advance, lambda loose: _laid(loose, Start()), c, lengths, layout.STEP) if c[RADIUS] > 0.0 else c


def _nodes(c: Float) -> Float:
    count, at = int(c[layout.ELEMENTS]), int(c[layout.LENGTHS])
    return np.concatenate([[0.0], np.cumsum(c[at : at + count])])


def _placed(c: Float, start: Start) -> tuple[Placed, Float, Float]:
    """The fibre at its nodes with slopes and their rates, by differences along the fibre."""
    at, d = _nodes(c), 1e-6
    at = at * (c[LENGTH] / at[-1])
    before, after = np.clip(at - d, 0.0, c[LENGTH]), np.clip(at + d, 0.0, c[LENGTH])
    one, two, step = place(c, start, before), place(c, start, after), (after - before)[:, None]
    return place(c, start, at), (two.points - one.points) / step, (two.velocities - one.velocities) / step


def _pack(c: Float, u: float, points: Float, slopes: Float, s: float) -> Float:
    inner = np.concatenate([points[1:-1], slopes[1:-1]], axis=1).reshape(-1)
    return np.concatenate([[u], slopes[0], inner, slopes[-1], [s]])


def _laid(c: Float, start: Start) -> Float:
    """The state of a fibre laid on its path, everything at rest."""
    n, points = 4 * int(c[layout.ELEMENTS]) + 2, int(c[layout.ELEMENTS]) * _POINTS
    placed, slopes, _ = _placed(c, start)
    q = _pack(c, start.u, placed.points, slopes, placed.s)
    return np.concatenate(
        [[q[0], 0.0], q[1:], np.zeros(n - 1 + n + points + memory(n, layout.BAND, points, int(c[layout.ORDER])))]
    )


def _start(c: Float, start: Start) -> Float:
    n, points, state = 4 * int(c[layout.ELEMENTS]) + 2, int(c[layout.ELEMENTS]) * _POINTS, _laid(c, start)
    rest(_advance, c, state, start, layout.STEP)
    placed, _, rates = _placed(c, start)
    v = _pack(c, start.v, placed.velocities, rates, placed.rim_speed)
    state[1], state[1 + n : 2 * n], state[2 * n : 3 * n] = v[0], v[1:], 0.0
    state[-memory(n, layout.BAND, points, int(c[layout.ORDER])) :] = 0.0
    return state


def _advance(c: Float, state: Float, drive: Float, dt: float, out: Float) -> int:
    from twin.kernels import fibre_ancf, fibre_step

    count = int(c[layout.ELEMENTS])
    steps = max(1, math.ceil(dt / c[layout.STEP] - 1e-6))
    size = np.array([4 * count + 2, layout.BAND, count * _POINTS, steps, int(c[layout.ORDER])], dtype=np.int64)
    return int(fibre_step.advance(fibre_ancf.assemble, fibre_ancf.gauge, size, _norm(c), c, state, drive, dt, out))


def _norm(c: Float) -> Float:
    """m per unit of each unknown: a slope counts by a quarter of its element's length."""
    nodes = _nodes(c)
    reach = np.gradient(nodes) / 4
    inner = np.stack([np.ones(len(nodes) - 2)] * 2 + [reach[1:-1]] * 2, axis=1).reshape(-1)
    return np.concatenate([[1.0], [reach[0]] * 2, inner, [reach[-1]] * 2, [1.0]])


def _warm() -> None:
    from twin.kernels import fibre_ancf  # noqa: F401


MODEL = FibreModel(
    name="ancf",
    title="ANCF cable elements",
    source=Source("Bulin, Hajzman, Polach", 2017, "planar L2T2 elements; here Berzeri, Shabana 2000, L2T1"),
    systems=frozenset({System.WFPD, System.WF}),
    parameters=_PARAMETERS,
    state=("u", "u'", "nodes' positions and slopes", "s", "their rates", "s'", "accelerations", "bristles"),
    constants=_constants,
    start=_start,
    advance=_advance,
    warm=_warm,
)
