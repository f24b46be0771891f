"""The frictionless point-mass chain in Exudyn: native masses, spring-dampers and a reeving spring over the sheave.

Everything runs in its compiled code: the drive's sinusoid is the motion of a heavy mass on a spring.
"""

from __future__ import annotations

import math
import sys
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from twin.kernels import fibre_layout as rig
from twin.kernels.fibre_chain_layout import COUNT, POINT_MASS, SEGMENT, STIFFNESS

Float = NDArray[np.float64]
HEAVY = 1e9  # kg: the fibre must not move the drive


def solve(c: Float, nodes: Float, amplitude: float, omega: float, seconds: float, step: float) -> tuple[Float, float]:
    """(t, u) of the weight and the seconds of computing; x = amplitude (1 - cos(omega t)).

    c: the chain's constants. nodes: the masses' positions at the start [n, 2].
    """
    exu = fast_exudyn()
    from exudyn.utilities import SensorNode

    system = exu.SystemContainer().AddSystem()
    weight = _build(system, exu, c, nodes, amplitude, omega)
    displacement = exu.OutputVariableType.Displacement
    sensor = system.AddSensor(
        SensorNode(nodeNumber=weight, outputVariableType=displacement, storeInternal=True, writeToFile=False)
    )
    system.Assemble()
    settings = settings_of(exu, seconds, step)
    began = time.perf_counter()
    system.SolveDynamic(settings, exu.DynamicSolverType.GeneralizedAlpha)
    return np.asarray(system.GetSensorStoredData(sensor))[:, :2], time.perf_counter() - began


def fast_exudyn() -> Any:
    """Exudyn in its fastest build, without range checks."""
    sys.exudynFast = True  # type: ignore[attr-defined]
    import exudyn

    return exudyn


def settings_of(exu: Any, seconds: float, step: float, radius: float = 0.9, modified: bool = True) -> Any:
    """Its implicit solver with a modified (or full) Newton method and a spectral radius, no files."""
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(seconds / step)
    settings.timeIntegration.endTime = seconds
    settings.timeIntegration.newton.useModifiedNewton = modified
    settings.timeIntegration.newton.relativeTolerance = 1e-9
    settings.timeIntegration.generalizedAlpha.spectralRadius = radius
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = max(step, 5e-4)
    return settings


def _build(system: Any, exu: Any, c: Float, points: Float, amplitude: float, omega: float) -> int:
    """Weight, masses and drive in a frame whose x axis is the weight's strand; returns the weight's node."""
    from exudyn import utilities as item

    turn = -math.atan2(c[rig.WTY], c[rig.WTX])
    frame = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])

    def at(point: Float) -> list[float]:
        return [*(frame @ point), 0.0]

    def mass(point: Float, kg: float, rigid: bool = False) -> tuple[int, int]:
        if rigid:  # what a reeving spring ends on
            node = system.AddNode(item.NodeRigidBody2D(referenceCoordinates=[*at(point)[:2], 0.0]))
            body = system.AddObject(item.RigidBody2D(nodeNumber=node, mass=kg, inertia=1e-3))
            return node, system.AddMarker(item.MarkerBodyRigid(bodyNumber=body, localPosition=[0, 0, 0]))
        node = system.AddNode(item.NodePoint2D(referenceCoordinates=at(point)[:2]))
        system.AddObject(item.MassPoint2D(nodeNumber=node, mass=kg))
        return node, system.AddMarker(item.MarkerNodePosition(nodeNumber=node))

    along, away = np.array([c[rig.WTX], c[rig.WTY]]), np.array([c[rig.DTX], c[rig.DTY]])
    weight, first = mass(np.array([c[rig.WX], c[rig.WY]]) - along * c[rig.ALONG], c[rig.MASS])
    fixed = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=system.AddNode(item.NodePointGround()), coordinate=0))
    guide = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=weight, coordinate=1))
    system.AddObject(item.CoordinateConstraint(markerNumbers=[fixed, guide]))
    system.AddLoad(item.Force(markerNumber=first, loadVector=[-c[rig.WEIGHT], 0, 0]))
    split = int(np.flatnonzero(points[:, 0] < 0)[-1]) + 1
    gravity = [p * c[POINT_MASS] for p in at(np.array([c[rig.GX], c[rig.GY]]))]
    markers = [first]
    for i, point in enumerate(points):
        markers.append(mass(point, c[POINT_MASS], i in (split - 1, split))[1])
        system.AddLoad(item.Force(markerNumber=markers[-1], loadVector=gravity))
    end = np.array([c[rig.DX], c[rig.DY]]) + away * c[rig.DRIVE_STRAND]
    markers.append(mass(end, HEAVY)[1])
    ground = system.AddObject(item.ObjectGround())
    anchor = system.AddMarker(item.MarkerBodyPosition(bodyNumber=ground, localPosition=at(end + away * amplitude)))
    spring = [HEAVY * omega**2] * 3
    system.AddObject(item.CartesianSpringDamper(markerNumbers=[anchor, markers[-1]], stiffness=spring))
    _springs(system, exu, item, c, markers, split, ground)
    return weight


def _springs(system: Any, exu: Any, item: Any, c: Float, markers: list[int], split: int, ground: int) -> None:
    stiffness, length = float(c[STIFFNESS]), float(c[SEGMENT])
    damping = stiffness * float(c[rig.TAU])
    axis = system.AddMarker(item.MarkerBodyRigid(bodyNumber=ground, localPosition=[0, 0, 0]))
    for i in range(int(c[COUNT]) + 1):
        pair = [markers[i], markers[i + 1]]
        if i != split:
            spring = item.SpringDamper(markerNumbers=pair, referenceLength=length, stiffness=stiffness, damping=damping)
            system.AddObject(spring)
            continue
        system.AddObject(
            item.ReevingSystemSprings(
                markerNumbers=[pair[0], axis, pair[1]],
                hasCoordinateMarkers=False,
                stiffnessPerLength=stiffness * length,
                dampingPerLength=damping * length,
                referenceLength=length,
                sheavesAxes=exu.Vector3DList([[0, 0, -1]] * 3),
                sheavesRadii=[0, float(c[rig.RADIUS]), 0],
            )
        )
