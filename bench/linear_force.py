"""The frictionless taut force model in Exudyn and in MuJoCo: weight, rim and drive on two spring-dampers.

Both get an easier job than ours, whose guide rubs: their compiled friction laws are not F_c tanh(v/v_s). The drive's
sinusoid is the motion of a heavy mass on a spring. Zero is the state at rest, whose tension balances the weight.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.exudyn_chain import fast_exudyn, settings_of
from bench.scipy_force import Balances
from stand.setup import Setup

Float = NDArray[np.float64]
HEAVY = 1e13  # kg: 15 N must not move the drive by 1e-8 of its stroke
SOLVERS = ("RK44", "RK67", "GeneralizedAlpha")


def exudyn(
    setup: Setup, amplitude: float, omega: float, seconds: float, step: float, solver: str
) -> tuple[Float, float]:
    """(t, u) and the seconds of computing, by one of SOLVERS."""
    exu = fast_exudyn()
    from exudyn import utilities as item

    b, system = Balances(setup), exu.SystemContainer().AddSystem()
    ground = system.AddMarker(
        item.MarkerNodeCoordinate(nodeNumber=system.AddNode(item.NodePointGround()), coordinate=0)
    )

    def mass(kg: float) -> tuple[int, int]:
        node = system.AddNode(item.Node1D(referenceCoordinates=[0.0]))
        system.AddObject(item.Mass1D(nodeNumber=node, mass=kg))
        return node, system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))

    (node, weight), (_, rim), (_, drive) = mass(b.m), mass(b.rim), mass(HEAVY)
    for pair, c, d, offset in (
        ((weight, rim), b.c1, b.b1, 0.0),
        ((rim, drive), b.c2, b.b2, 0.0),
        ((ground, drive), HEAVY * omega**2, 0.0, amplitude),
    ):
        spring = item.CoordinateSpringDamper(markerNumbers=list(pair), stiffness=c, damping=d, offset=offset)
        system.AddObject(spring)
    kind = exu.OutputVariableType.Coordinates
    sensor = system.AddSensor(
        item.SensorNode(nodeNumber=node, outputVariableType=kind, storeInternal=True, writeToFile=False)
    )
    system.Assemble()
    settings = settings_of(exu, seconds, step)
    settings.timeIntegration.explicitIntegration.useLieGroupIntegration = False
    began = time.perf_counter()
    system.SolveDynamic(settings, getattr(exu.DynamicSolverType, solver))
    return np.asarray(system.GetSensorStoredData(sensor))[:, :2], time.perf_counter() - began


_WORLD = """<mujoco><option gravity="0 0 0" integrator="RK4" timestep="{step}"><flag contact="disable"/></option>
<worldbody>
<body><joint name="u" type="slide" axis="1 0 0"/><geom size="1" mass="{m}"/></body>
<body><joint name="s" type="slide" axis="1 0 0"/><geom size="1" mass="{rim}"/></body>
<body><joint name="x" type="slide" axis="1 0 0" stiffness="{k}" springref="{amplitude}"/>
<geom size="1" mass="{heavy}"/></body>
</worldbody><tendon>
<fixed stiffness="{c1}" damping="{b1}" springlength="0"><joint joint="s" coef="1"/><joint joint="u" coef="-1"/></fixed>
<fixed stiffness="{c2}" damping="{b2}" springlength="0"><joint joint="x" coef="1"/><joint joint="s" coef="-1"/></fixed>
</tendon></mujoco>"""


def mujoco(setup: Setup, amplitude: float, omega: float, seconds: float, dt: float, parts: int) -> tuple[Float, float]:
    """(t, u) at every sample of dt and the seconds of computing, `parts` Runge-Kutta steps of order 4 a sample."""
    import mujoco as mj

    b = Balances(setup)
    values: dict[str, Any] = {"m": b.m, "rim": b.rim, "c1": b.c1, "c2": b.c2, "b1": b.b1, "b2": b.b2}
    world = _WORLD.format(
        step=repr(dt / parts), heavy=HEAVY, k=repr(HEAVY * omega**2), amplitude=repr(amplitude), **values
    )
    model = mj.MjModel.from_xml_string(world)
    data, u = mj.MjData(model), np.empty(round(seconds / dt))
    began = time.perf_counter()
    for i in range(len(u)):
        mj.mj_step(model, data, parts)
        u[i] = data.qpos[0]
    spent = time.perf_counter() - began
    return np.column_stack([np.arange(1, len(u) + 1) * dt, u]), spent
