"""Lay a fibre along its path at a measured instant: from the weight, over the pulley, to the drive."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.kernels.fibre_layout import (
    ALONG,
    DRIVE_STRAND,
    DTX,
    DTY,
    DX,
    DY,
    EA,
    FIBRE_MASS,
    GX,
    GY,
    LENGTH,
    OFFSET,
    RADIUS,
    REST,
    TAU,
    WTX,
    WTY,
    WX,
    WY,
)
from twin.model import Start

Float = NDArray[np.float64]


@dataclass(frozen=True)
class Placed:
    """points, velocities: [n, 2], m, m/s, at the material coordinates asked for; split: the one at the arc's middle,
    m; s, rim_speed: of the pulley, m, m/s; strains: weight's side and drive's side."""

    points: Float
    velocities: Float
    split: float
    s: float
    rim_speed: float
    strains: tuple[float, float]


def place(c: Float, start: Start, at: Float) -> Placed:
    """The fibre with uniform strain on each side of the arc's middle; slack hangs as sag in the straight strands.

    c: constants that begin with the rig's. at: material coordinates from the weight's end, m [n].
    """
    arc = _arc(c)
    weight = math.hypot(c[ALONG] - start.u, c[OFFSET])
    drive = c[DRIVE_STRAND] + start.x
    one, two = weight + arc / 2, arc / 2 + drive
    speed = start.v * (c[ALONG] - start.u) / weight
    split, s = _split(c, start, one, two, (start.w - speed) / c[LENGTH])
    strains = (one / split - 1.0, two / (c[LENGTH] - split) - 1.0 if two > 0 else 0.0)
    rim = start.rim_speed if start.rim_speed is not None else speed + (start.w - speed) * split / c[LENGTH]
    distance = np.where(at <= split, at * (one / split), one + (at - split) * (1.0 + strains[1]))
    along = np.interp(at, [0.0, split, max(c[LENGTH], split + 1e-12)], [speed, rim, start.w])
    points, directions = _path(c, weight, arc, drive, distance, strains)
    return Placed(points, directions * along[:, None], split, s, rim, strains)


def _arc(c: Float) -> float:
    return float(c[RADIUS]) * (math.atan2(c[WY], c[WX]) - math.atan2(c[DY], c[DX])) if c[RADIUS] > 0 else 0.0


def _split(c: Float, start: Start, one: float, two: float, rate: float) -> tuple[float, float]:
    """Material coordinate at the arc's middle and the rim's displacement that goes with it."""
    if c[RADIUS] == 0.0:
        return float(c[LENGTH]), 0.0
    rest = (math.hypot(c[ALONG], c[OFFSET]) + _arc(c) / 2) / (1.0 + c[REST] / c[EA])
    if start.s is not None:
        return rest - start.s, start.s
    if start.force is not None and start.force > 0 and one + two > c[LENGTH]:
        strain = max(start.force / c[EA] - c[TAU] * rate, 0.0)
        split = c[LENGTH] - two / (1.0 + strain)
    else:
        split = c[LENGTH] * one / (one + two)
    return float(split), float(rest - split)


def _path(
    c: Float, weight: float, arc: float, drive: float, distance: Float, strains: tuple[float, float]
) -> tuple[Float, Float]:
    """Points and unit directions of travel at `distance` from the weight along the path."""
    points, directions = np.empty((len(distance), 2)), np.empty((len(distance), 2))
    first, last = distance <= weight, distance >= weight + arc
    middle = ~(first | last)
    to, frm = np.array([c[WTX], c[WTY]]), np.array([c[DTX], c[DTY]])
    end = np.array([c[WX], c[WY]])
    points[first] = end + np.outer(distance[first] - weight, to)
    directions[first] = to
    points[last] = np.array([c[DX], c[DY]]) + np.outer(distance[last] - weight - arc, frm)
    directions[last] = frm
    if arc > 0:
        angle = math.atan2(c[WY], c[WX]) - (distance[middle] - weight) / c[RADIUS]
        points[middle] = c[RADIUS] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        directions[middle] = np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    points[first] += _sag(c, distance[first] / weight, weight, weight + arc / 2, strains[0], to)
    if drive > 0:
        points[last] += _sag(c, (distance[last] - weight - arc) / drive, drive, drive + arc / 2, strains[1], frm)
    return points, directions


def _sag(c: Float, part: Float, length: float, side: float, strain: float, along: Float) -> Float:
    """Transverse offset [n, 2] of a strand: a parabola under its own weight, or that which takes up the slack."""
    normal = np.array([-along[1], along[0]])
    pull = float(normal @ np.array([c[GX], c[GY]]))
    tension = c[EA] * strain
    if tension > 1.0:
        rise = c[FIBRE_MASS] / c[LENGTH] * pull * length**2 / (8 * tension)
    else:
        rise = math.copysign(math.sqrt(max(-strain, 0.0) * side * 3 * length / 8), pull or 1.0)
    return np.outer(4 * rise * part * (1 - part), normal)
