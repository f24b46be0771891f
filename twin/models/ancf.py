"""Planar ANCF cable elements: large motion, axial and bending stiffness, contact with friction (S0, section 3.2)."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from stand.setup import Setup, System
from twin.friction import packed
from twin.kernels import fibre_ancf_layout as layout
from twin.kernels.fibre_layout import DRAG, DRY, LENGTH, MASS, RADIUS, RIG, RIM, WEIGHT, pack_rig
from twin.model import FibreModel, Float, Start
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
)
_POINTS = 12  # contact points of an element
_MARGIN = 0.003  # m of fine elements on either side of arc and stroke
_SETTLE, _SETTLE_DRAG = 100, 300.0  # samples, 1/s


def mesh(length: float, first: float, last: float, elements: int, fine: int) -> Float:
    """Lengths of the elements [elements], m: `fine` of them between `first` and `last`, the rest on both sides."""
    if last <= first:
        return np.full(elements, length / elements)
    fine = min(fine, elements - 2)
    left = max(1, min(elements - fine - 1, round((elements - fine) / 2)))
    parts = ((first, left), (last - first, fine), (length - last, elements - fine - left))
    return np.concatenate([np.full(n, size / n) for size, n in parts])


def _constants(setup: Setup, parameters: Mapping[str, float]) -> Float:
    elements, bending, friction, contact, bristle, stroke, drag, step, fine, evenness = packed(_PARAMETERS, parameters)
    count = round(elements)
    extra = count + 5 * layout.GAUSS + 4 * _POINTS
    c = pack_rig(setup, layout.OWN + extra, sliding=friction, drag=drag)
    lengths = RIG + layout.OWN
    c[RIG:lengths] = [count, _POINTS, bending, contact, bristle, step, lengths, lengths + count, evenness]
    c[lengths : lengths + count] = mesh(c[LENGTH], *_fine(c, setup, stroke), count, round(fine))
    c[lengths + count : lengths + extra] = layout.tables(_POINTS)
    return _trimmed(c) if c[RADIUS] > 0.0 else c


def _trimmed(c: Float) -> Float:
    """The fibre made longer until the weight rests at u = 0: its bending stiffness lifts it off the ends of the arc."""
    loose = c.copy()
    loose[MASS], loose[DRY], loose[DRAG], loose[layout.STEP] = 0.02, 0.0, _SETTLE_DRAG, 1e-3
    first = int(c[layout.LENGTHS])
    for _ in range(3):
        state = _state(loose, Start())
        _hold(loose, state, Start())
        loose[first] += state[0]
    c[first] = loose[first]
    return c


def _fine(c: Float, setup: Setup, stroke: float) -> tuple[float, float]:
    if c[RADIUS] == 0.0:
        return 0.0, 0.0
    arc = setup.pulley_radius * setup.wrap_angle
    first = max(setup.weight_strand_length - stroke - _MARGIN, 0.1 * setup.weight_strand_length)
    return first, min(setup.weight_strand_length + arc + _MARGIN, c[LENGTH] - 0.1 * setup.drive_strand_length)


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


def _state(c: Float, start: Start) -> Float:
    """The state of a fibre laid on its path, everything at rest."""
    n, points = 4 * int(c[layout.ELEMENTS]) + 2, int(c[layout.ELEMENTS]) * _POINTS
    placed, slopes, _ = _placed(c, start)
    q = _pack(c, start.u, placed.points, slopes, placed.s)
    return np.concatenate([[q[0], 0.0], q[1:], np.zeros(n - 1 + n + points)])


def _start(c: Float, start: Start) -> Float:
    n, state = 4 * int(c[layout.ELEMENTS]) + 2, _state(c, start)
    held = c.copy()
    held[MASS], held[WEIGHT], held[DRY], held[DRAG], held[layout.STEP] = 1e9, 0.0, 0.0, _SETTLE_DRAG, 1e-3
    if start.s is not None or start.force is not None:
        held[RIM] = 1e9
    _hold(held, state, start)
    placed, _, rates = _placed(c, start)
    v = _pack(c, start.v, placed.velocities, rates, placed.rim_speed)
    state[0], state[1], state[1 + n : 2 * n], state[2 * n : 3 * n] = start.u, v[0], v[1:], 0.0
    return state


def _hold(c: Float, state: Float, start: Start) -> None:
    """Let the fibre find its shape on the pulley under `c`, the drive standing still."""
    drive = np.zeros((_SETTLE + 1, 2))
    drive[:, 0] = start.x
    if _advance(c, state, drive, 1e-3, np.empty((_SETTLE, 3))) != 0:
        raise RuntimeError("the fibre finds no shape on the pulley at rest")


def _advance(c: Float, state: Float, drive: Float, dt: float, out: Float) -> int:
    from twin.kernels import fibre_ancf, fibre_step

    count = int(c[layout.ELEMENTS])
    steps = max(1, math.ceil(dt / c[layout.STEP] - 1e-6))
    size = np.array([4 * count + 2, layout.BAND, count * _POINTS, steps], dtype=np.int64)
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
