"""Point masses joined by unilateral spring-dampers, transverse motion and pulley contact included (S0, section 2)."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from stand.setup import Setup, System
from twin.friction import packed
from twin.kernels.fibre_chain_layout import BAND, ORDER, OWN
from twin.kernels.fibre_layout import EA, FIBRE_MASS, LENGTH, RADIUS, RIG, pack_rig
from twin.kernels.fibre_order import memory, order_of
from twin.model import FibreModel, Float, Start
from twin.models._place import place
from twin.parameter import Parameter, Source

_PARAMETERS = (
    Parameter("masses", "-", 7.0, (1.0, 200.0), None, "number of point masses"),
    Parameter("pulley_friction", "-", 0.3, (0.0, 2.0), 0.1, "between fibre and rim; 0: frictionless"),
    Parameter("bond_length", "m", 0.005, (0.001, 0.05), None, "stretch of fibre by which a stuck fibre yields"),
    Parameter("fibre_drag", "1/s", 0.0, (0.0, 100.0), None, "mass-proportional damping"),
    Parameter("step", "s", 5e-4, (1e-5, 1e-2), None, "longest step of the integrator"),
    Parameter("order", "-", 2.0, (2.0, 4.0), None, "of the integrator: 2, or 4 where accuracy counts"),
)


def _constants(setup: Setup, parameters: Mapping[str, float]) -> Float:
    masses, friction, bond, drag, step, order = packed(_PARAMETERS, parameters)
    count = round(masses)
    c = pack_rig(setup, OWN, sliding=friction, drag=drag)
    segment = c[LENGTH] / (count + 1)
    wrap = setup.wrap_angle if c[RADIUS] > 0 else 0.0
    own = [
        count,
        c[FIBRE_MASS] / count,
        segment,
        c[EA] / segment,
        1e-4,
        1e5,
        bond,
        5e-6,
        math.exp(friction * wrap),
        step,
        2.0,
        order_of(order),
    ]
    c[RIG : RIG + len(own)] = own
    return c


def _start(c: Float, start: Start) -> Float:
    count = int(c[RIG])
    n, segment = 2 * count + 2, c[RIG + 2]
    placed = place(c, start, segment * np.arange(1, count + 1))
    state = np.zeros(3 * n + 2 + memory(n, BAND, 2, int(c[ORDER])))
    state[0], state[1] = start.u, start.v
    state[2:n], state[n] = placed.points.reshape(-1), placed.s
    state[n + 1 : 2 * n - 1], state[2 * n - 1] = placed.velocities.reshape(-1), placed.rim_speed
    state[3 * n] = placed.split + placed.s
    state[3 * n + 1] = min(int(placed.split / segment), count)
    return state


def _advance(c: Float, state: Float, drive: Float, dt: float, out: Float) -> int:
    from twin.kernels import fibre_chain, fibre_step

    count = int(c[RIG])
    steps = max(1, math.ceil(dt / c[RIG + 9] - 1e-6))
    size = np.array([2 * count + 2, BAND, 2, steps, int(c[ORDER])], dtype=np.int64)
    return int(
        fibre_step.advance(
            fibre_chain.assemble, fibre_chain.gauge, size, np.ones(2 * count + 2), c, state, drive, dt, out
        )
    )


def _warm() -> None:
    from twin.kernels import fibre_chain  # noqa: F401


MODEL = FibreModel(
    name="point-mass",
    title="Point masses",
    source=Source("Polach, Hajzman, Bulin", 2020, "section 3.2; Kamman, Huston, 2001"),
    systems=frozenset({System.WFPD, System.WF}),
    parameters=_PARAMETERS,
    state=("u", "u'", "masses' positions", "s", "masses' velocities", "s'", "accelerations", "contact"),
    constants=_constants,
    start=_start,
    advance=_advance,
    warm=_warm,
)
