"""The ANCF fibre in Exudyn: its planar cable elements, a circle that they touch without friction, a driven end.

Everything runs in its compiled code, as in `bench.exudyn_chain`; weight and drive are masses on the end nodes.
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.exudyn_chain import HEAVY, fast_exudyn, settings_of
from twin.kernels import fibre_ancf_layout as own
from twin.kernels import fibre_layout as rig

Float = NDArray[np.float64]
#: straight pieces of an element on which Exudyn looks for contact: as many as our points
PIECES = 12
REST = 0.1  # s


def solve(
    c: Float,
    state: Float,
    amplitude: float,
    omega: float,
    seconds: float,
    step: float,
    radius: float = 0.9,
    modified: bool = True,
) -> tuple[Float, float]:
    """(t, u) of the weight and the seconds of computing; x = amplitude (1 - cos(omega t)).

    c, state: the ANCF model's constants and its start at rest. radius: spectral radius. modified: Newton's method.
    """
    exu = fast_exudyn()
    points, slopes = _nodes(c, state)
    for _ in range(2):  # its pieces are chords: it finds its own rest first
        system = exu.SystemContainer().AddSystem()
        _build(system, exu, c, points, slopes, 0.0, omega)
        system.Assemble()
        system.SolveDynamic(settings_of(exu, REST, 2.5e-4, 0.5), exu.DynamicSolverType.GeneralizedAlpha)
        moved = np.asarray(system.systemData.GetODE2Coordinates()).reshape(-1, 4)
        back = _frame(c).T
        points, slopes = points + moved[:, :2] @ back.T, slopes + moved[:, 2:] @ back.T
    settings = settings_of(exu, seconds, step, radius, modified)
    return _run(exu, c, points, slopes, amplitude, omega, settings)


def _run(
    exu: Any, c: Float, points: Float, slopes: Float, amplitude: float, omega: float, settings: Any
) -> tuple[Float, float]:
    from exudyn.utilities import SensorNode

    system = exu.SystemContainer().AddSystem()
    weight = _build(system, exu, c, points, slopes, amplitude, omega)
    displacement = exu.OutputVariableType.Displacement
    sensor = system.AddSensor(
        SensorNode(nodeNumber=weight, outputVariableType=displacement, storeInternal=True, writeToFile=False)
    )
    system.Assemble()
    began = time.perf_counter()
    system.SolveDynamic(settings, exu.DynamicSolverType.GeneralizedAlpha)
    return np.asarray(system.GetSensorStoredData(sensor))[:, :2], time.perf_counter() - began


def _frame(c: Float) -> Float:
    """Turns the weight's strand onto the x axis."""
    turn = -math.atan2(c[rig.WTY], c[rig.WTX])
    return np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])


def _nodes(c: Float, state: Float) -> tuple[Float, Float]:
    """Positions and slopes of all nodes [n, 2] at the start, the drive at x = 0, the weight at u = 0."""
    count = int(c[own.ELEMENTS])
    inner = state[4 : 4 * count].reshape(-1, 4)
    first = np.array([c[rig.WX], c[rig.WY]]) - np.array([c[rig.WTX], c[rig.WTY]]) * c[rig.ALONG]
    last = np.array([c[rig.DX], c[rig.DY]]) + np.array([c[rig.DTX], c[rig.DTY]]) * c[rig.DRIVE_STRAND]
    points = np.vstack([first, inner[:, :2], last])
    return points, np.vstack([state[2:4], inner[:, 2:], state[4 * count : 4 * count + 2]])


def _build(system: Any, exu: Any, c: Float, points: Float, slopes: Float, amplitude: float, omega: float) -> int:
    """All in a frame whose x axis is the weight's strand; returns the weight's node."""
    from exudyn import utilities as item

    frame = _frame(c)
    nodes = [
        system.AddNode(item.NodePoint2DSlope1(referenceCoordinates=[*(frame @ p), *(frame @ s)]))
        for p, s in zip(points, slopes, strict=True)
    ]
    gravity = [*(frame @ np.array([c[rig.GX], c[rig.GY]])), 0.0]
    ground = system.AddObject(item.ObjectGround())
    axis = system.AddMarker(item.MarkerBodyPosition(bodyNumber=ground, localPosition=[0, 0, 0]))
    lengths = c[int(c[own.LENGTHS]) :][: int(c[own.ELEMENTS])]
    for e, length in enumerate(lengths):
        cable = system.AddObject(_cable(item, c, nodes[e : e + 2], float(length)))
        mass = system.AddMarker(item.MarkerBodyMass(bodyNumber=cable))
        system.AddLoad(item.LoadMassProportional(markerNumber=mass, loadVector=gravity))
        if np.linalg.norm(points[e : e + 2], axis=1).min() < c[rig.RADIUS] + 0.1:
            _touch(system, item, c, cable, axis, float(length))
    _ends(system, item, c, nodes, frame, amplitude, omega)
    return int(nodes[0])


def _cable(item: Any, c: Float, nodes: list[int], length: float) -> Any:
    return item.Cable2D(
        length=length,
        massPerLength=float(c[rig.FIBRE_MASS] / c[rig.LENGTH]),
        bendingStiffness=float(c[own.EI]),
        axialStiffness=float(c[rig.EA]),
        bendingDamping=float(c[own.EI] * c[rig.TAU]),
        axialDamping=float(c[rig.EA] * c[rig.TAU]),
        nodeNumbers=nodes,
        useReducedOrderIntegration=2,
    )


def _touch(system: Any, item: Any, c: Float, cable: int, axis: int, length: float) -> None:
    data = system.AddNode(item.NodeGenericData(initialCoordinates=[0.1] * PIECES, numberOfDataCoordinates=PIECES))
    shape = system.AddMarker(item.MarkerBodyCable2DShape(bodyNumber=cable, numberOfSegments=PIECES))
    system.AddObject(
        item.ObjectContactCircleCable2D(
            markerNumbers=[axis, shape],
            nodeNumber=data,
            numberOfContactSegments=PIECES,
            contactStiffness=float(c[own.CONTACT]) * length / PIECES,
            circleRadius=float(c[rig.RADIUS]),
        )
    )


def _ends(system: Any, item: Any, c: Float, nodes: list[int], frame: Float, amplitude: float, omega: float) -> None:
    """The weight in its guide; the drive's sinusoid as the motion of a heavy mass on a spring."""

    def added(kg: float) -> Float:
        return np.diag([kg, kg, 0.0, 0.0])

    system.AddObject(item.ObjectGenericODE2(nodeNumbers=[nodes[0]], massMatrix=added(float(c[rig.MASS]))))
    pull = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=0))
    system.AddLoad(item.LoadCoordinate(markerNumber=pull, load=-float(c[rig.WEIGHT])))
    guide = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=1))
    fixed = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=system.AddNode(item.NodePointGround()), coordinate=0))
    system.AddObject(item.CoordinateConstraint(markerNumbers=[fixed, guide]))
    away = frame @ np.array([c[rig.DTX], c[rig.DTY]])
    force = [*(HEAVY * omega**2 * amplitude * away), 0.0, 0.0]
    system.AddObject(
        item.ObjectGenericODE2(
            nodeNumbers=[nodes[-1]],
            massMatrix=added(HEAVY),
            stiffnessMatrix=added(HEAVY * omega**2),
            forceVector=force,
        )
    )
