"""Ritz: strands of variable free length with polynomial modes, no slip on the pulley (S0, section 2)."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from stand.setup import Setup, System
from twin.friction import packed
from twin.kernels import fibre_ritz_layout as layout
from twin.kernels.fibre_layout import (
    ALONG,
    DRIVE_STRAND,
    DTX,
    DTY,
    EA,
    FIBRE_MASS,
    GX,
    GY,
    LENGTH,
    OFFSET,
    RADIUS,
    REST,
    RIG,
    TAU,
    WTX,
    WTY,
    pack_rig,
)
from twin.kernels.fibre_order import memory
from twin.model import FibreModel, Float, Start
from twin.parameter import Parameter, Source

_PARAMETERS = (
    Parameter("fibre_drag", "1/s", 0.0, (0.0, 100.0), None, "mass-proportional damping"),
    Parameter("step", "s", 5e-4, (1e-6, 1e-2), None, "longest step of the integrator"),
)
_N = 2 + 2 * layout.MODES


def _constants(setup: Setup, parameters: Mapping[str, float]) -> Float:
    drag, step = packed(_PARAMETERS, parameters)
    c = pack_rig(setup, layout.OWN, drag=drag)
    stretched = 1.0 + c[REST] / c[EA]
    first, second = setup.weight_strand_length / stretched, c[DRIVE_STRAND] / stretched
    c[RIG : RIG + 5] = [step, first, second, 5e-6, RIG + 5]
    c[RIG + 5 : RIG + layout.OWN] = layout.table()
    return c


def _start(c: Float, start: Start) -> Float:
    near, far = math.hypot(c[ALONG] - start.u, c[OFFSET]), c[DRIVE_STRAND] + start.x
    first, second, pulley = c[layout.FIRST], c[layout.SECOND], c[RADIUS] > 0.0
    speed = start.v * (c[ALONG] - start.u) / near
    s = _rim(c, start, near, far, (start.w - speed) / (first + second)) if pulley else 0.0
    rim = speed + (start.w - speed) * first / (first + second)
    state = np.zeros(3 * _N + memory(_N, layout.BAND, 0, 2))
    state[0], state[1], state[_N] = start.u, start.v, s
    state[2 * _N - 1] = (start.rim_speed if start.rim_speed is not None else rim) if pulley else 0.0
    state[2 + layout.AXIAL] = _bow(c, near, first - s, np.array([c[WTX], c[WTY]]))
    if pulley:
        state[2 + layout.MODES + layout.AXIAL] = _bow(c, far, second + s, np.array([c[DTX], c[DTY]]))
    return state


def _rim(c: Float, start: Start, near: float, far: float, rate: float) -> float:
    """Where the pulley is: as measured, from the force, or so that both strands are stretched alike."""
    if start.s is not None:
        return start.s
    strain = (near + far) / (c[layout.FIRST] + c[layout.SECOND]) - 1.0
    if start.force is not None and start.force > 0 and strain > 0:
        strain = max(start.force / c[EA] - c[TAU] * rate, 0.0)
    return float(far / (1.0 + strain) - c[layout.SECOND])


def _bow(c: Float, span: float, length: float, along: Float) -> float:
    """Amplitude of a strand's first transverse mode: its sag by its own weight, or that which takes up the slack."""
    pull = float(np.array([-along[1], along[0]]) @ np.array([c[GX], c[GY]]))
    tension = c[EA] * (span / length - 1.0)
    if tension > 1.0:
        rise = c[FIBRE_MASS] / c[LENGTH] * pull * span**2 / (8 * tension)
    else:
        rise = math.copysign(math.sqrt(max(length - span, 0.0) * 3 * span / 8), pull or 1.0)
    return float(-rise * math.sqrt(6.0) / 1.5)  # the mode is -1.5 / sqrt(6) in the middle


def _advance(c: Float, state: Float, drive: Float, dt: float, out: Float) -> int:
    from twin.kernels import fibre_ritz, fibre_step

    steps = max(1, math.ceil(dt / c[layout.STEP] - 1e-6))
    size = np.array([_N, layout.BAND, 0, steps, 2], dtype=np.int64)
    return int(fibre_step.advance(fibre_ritz.assemble, fibre_ritz.gauge, size, np.ones(_N), c, state, drive, dt, out))


def _warm() -> None:
    from twin.kernels import fibre_ritz  # noqa: F401


MODEL = FibreModel(
    name="ritz",
    title="Ritz, variable free length",
    source=Source("Du, Agrawal", 2015, "as described in Polach, Hajzman, Bulin 2020, section 2"),
    systems=frozenset({System.WFPD, System.WF}),
    parameters=_PARAMETERS,
    state=("u", "u'", "modes of both strands", "s", "their rates", "s'", "accelerations"),
    constants=_constants,
    start=_start,
    advance=_advance,
    warm=_warm,
)
