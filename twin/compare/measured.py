"""A recording as the models take it: zeros from the rest, speeds, noise, where the run begins."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError
from stand.recording import Recording
from stand.setup import Setup, System
from twin.kernels.hermite import drive_table
from twin.model import Start
from twin.score.windows import parabola

Float = NDArray[np.float64]

#: s of rest from which zeros and noise are taken
REST = 0.4


@dataclass(frozen=True)
class Measured:
    """Channels [n] on the recording's time, u and x from the rest; drive: x and x' [n, 2].

    begin: the sample from which a model runs free (0, or the release), start: the state there.
    noise: one sigma of u (m) and F (N) over the rest. slack: share of samples with a slack fibre.
    snatch: s of the first catch after slack, or None.
    """

    setup: Setup
    time: Float
    dt: float
    drive: Float
    u: Float
    F: Float
    begin: int
    start: Start
    noise: tuple[float, float]
    slack: float
    snatch: float | None


def measured(recording: Recording) -> Measured:
    """InputError where the recording has no fibre, or a channel holds what is not a number."""
    setup, dt = recording.setup, recording.dt
    if setup.system is System.LINEAR_DRIVE:
        raise InputError(
            "no fibre to compare", where=recording.name, value=str(setup.system), remedy="Use `stand diagnose`"
        )
    _check_finite(recording)
    rest = max(8, min(round(REST / dt), len(recording.time) // 4))
    u = recording.u - float(np.median(recording.u[:rest]))
    drive = _drive(recording, rest, dt)
    begin = 0 if setup.system is System.WFPD else release(u, dt)
    noise = (_noise(u[:rest]), _noise(recording.F[:rest]))
    taut = taut_above(setup, noise[1])
    snatch = first_snatch(recording.F[begin:], taut, dt)
    return Measured(
        setup=setup,
        time=recording.time,
        dt=dt,
        drive=drive,
        u=u,
        F=recording.F,
        begin=begin,
        start=_start(u, drive, begin, dt),
        noise=noise,
        slack=float(np.mean(recording.F[begin:] < taut)),
        snatch=None if snatch is None else float(recording.time[begin] + snatch),
    )


def _check_finite(recording: Recording) -> None:
    for name, values in recording.channels.items():
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            raise InputError(
                f"{len(bad)} samples are not numbers, the first at {recording.time[bad[0]]:.4f} s",
                where=f"{recording.name}:/entry/data/{name}",
                remedy="Cut the run there, or fill short gaps before comparing",
            )
        if np.ptp(values) == 0.0:
            where, remedy = f"{recording.name}:/entry/data/{name}", "Check its cable and its gauge"
            raise InputError("is constant: nothing can be compared", where=where, value=float(values[0]), remedy=remedy)


def _drive(recording: Recording, rest: int, dt: float) -> Float:
    if recording.setup.system is not System.WFPD:
        return np.zeros((len(recording.time), 2))
    return drive_table(recording.x - float(np.median(recording.x[:rest])), dt)


def _noise(values: Float) -> float:
    """One sigma per sample from differences of neighbours, which a slow drift does not enter."""
    return float(np.std(np.diff(values)) / np.sqrt(2.0))


def _start(u: Float, drive: Float, begin: int, dt: float) -> Start:
    if begin == 0:
        return Start(x=float(drive[0, 0]), w=float(drive[0, 1]))
    half = min(20, begin)
    height, _ = parabola(u[begin - half : begin + half + 1], dt)
    return Start(u=height)


def taut_above(setup: Setup, noise: float) -> float:
    """The gauge's reading above which the fibre is taken to be taut, N: 4 sigma, and 5 % of the rest tension."""
    return max(4.0 * noise, 0.05 * setup.rest_tension)


def first_snatch(F: Float, taut: float, dt: float, least: float = 0.002) -> float | None:
    """s from the first sample to the first catch after the fibre was slack for at least `least`."""
    slack = taut > F
    edges = np.flatnonzero(np.diff(slack.astype(np.int8)))
    begins = [int(e) + 1 for e in edges if slack[e + 1]]
    if slack[0]:
        begins.insert(0, 0)
    for begin in begins:
        ends = np.flatnonzero(~slack[begin:])
        if len(ends) and ends[0] * dt >= least:
            return float((begin + ends[0]) * dt)
    return None


def release(u: Float, dt: float) -> int:
    """The sample at which the lifted weight is let go: the last at rest before the first fast fall."""
    step = max(1, round(0.005 / dt))
    speed = (u[2 * step :] - u[: -2 * step]) / (2 * step * dt)
    fast = np.flatnonzero(speed < -0.05)
    if not len(fast):
        raise InputError("the weight never falls", where="weight_position", remedy="Is this a release run?")
    slow = np.flatnonzero(speed[: fast[0]] > -0.01)
    return int((slow[-1] if len(slow) else 0) + step)
