"""A recording made ready: zeros, noise, smoothed motion, and the windows that can be restarted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stand.recording import Recording
from stand.setup import Setup, System
from twin.diagnosis.smooth import Smooth, noise, polynomial, smooth

Float = NDArray[np.float64]
Index = NDArray[np.int64]
REST = 0.4
BURN = 24
LENGTH = 184
HALF = 0.006  # s about a start that its local polynomials take in
SMOOTH = 0.008  # s about a start that must be smooth
LASTS = 0.092  # s of a window that are used at least where the rate is low, or FEWEST samples
FEWEST = 36
SLACK = 2.5e-4, 1e-3, 5e-3  # m, m per m/s and m per m by which a taut fibre may seem too long: give, delays and scales
CLEAR = 20  # samples about a start that must be good


@dataclass(frozen=True)
class Run:
    """One recording ready for diagnosis, in SI; u, x from rest.

    x, u, F: smoothed. rest_force: the gauge's mean at rest, N. bad: samples that must not be used, bool [n, 2] (u, F).
    """

    name: str
    setup: Setup
    dt: float
    raw_x: Float
    raw_u: Float
    raw_F: Float
    x: Smooth
    u: Smooth
    F: Smooth
    noise_x: float
    noise_u: float
    noise_F: float
    rest_force: float
    bad: NDArray[np.bool_]

    @property
    def seconds(self) -> float:
        """The run's length, s."""
        return len(self.raw_u) * self.dt

    @property
    def moving(self) -> NDArray[np.bool_]:
        """Samples within motion: the weight or the drive leaves its noise."""
        reach = np.abs(self.u.rate) + np.abs(self.x.rate)
        return np.convolve(reach > 0.004, np.ones(41), "same") > 0


def prepare(recording: Recording) -> Run:
    """The recording's channels without their zeros, with their noise and smoothed."""
    dt, n = recording.dt, len(recording.time)
    rest = max(8, round(REST / dt))
    setup = recording.setup
    axis = setup.system is System.LINEAR_DRIVE
    raw_u = (recording.x if axis else recording.u).copy()
    raw_F = (recording.channels["drive_force"] if axis else recording.F).copy()
    raw_x = raw_F.copy() if axis else (recording.x.copy() if setup.system is System.WFPD else np.zeros(n))
    if setup.system is System.WFPD:
        raw_x -= np.median(raw_x[:rest])
        raw_u -= np.median(raw_u[:rest])
    noises = [noise(c) for c in (raw_x, raw_u, raw_F)]
    sigma_x = max(noises[0], 0.0)
    return Run(
        recording.name,
        setup,
        dt,
        raw_x,
        raw_u,
        raw_F,
        smooth(raw_x, dt, max(sigma_x, 1e-7)),
        smooth(raw_u, dt, max(noises[1], 1e-7)),
        smooth(raw_F, dt, max(noises[2], 1e-3)),
        sigma_x,
        max(noises[1], 1e-7),
        max(noises[2], 1e-3),
        float(np.mean(raw_F[:rest])),
        _bad(recording, n),
    )


def _bad(recording: Recording, n: int) -> NDArray[np.bool_]:
    """Samples with no raw sample behind them, by the recording's quality bits."""
    bad = np.zeros((n, 2), dtype=bool)
    if recording.quality is not None:
        bad[:, 0] = (recording.quality & 0b1011) != 0
        bad[:, 1] = (recording.quality & 0b1101) != 0
    return bad


@dataclass(frozen=True)
class Windows:
    """Windows of all runs: run, first [w]; the data [w, LENGTH, 2] (u, F), where they count, and which are held out."""

    run: Index
    first: Index
    data: Float
    use: NDArray[np.bool_]
    held: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.run)

    def part(self, keep: NDArray[np.bool_] | Index) -> Windows:
        """Some of the windows."""
        return Windows(self.run[keep], self.first[keep], self.data[keep], self.use[keep], self.held[keep])


def half(dt: float, reach: float = HALF) -> int:
    """Samples in `reach` seconds, and as many as a polynomial needs at a low rate."""
    return max(4, round(reach / dt))


def choose(runs: tuple[Run, ...], per_run: int) -> Windows:
    """Up to `per_run` windows of each run, starting in smooth taut stretches, spread over its motion."""
    firsts = [_spread(run, _smooth_starts(run), per_run) for run in runs]
    run_of = np.repeat(np.arange(len(runs)), [len(f) for f in firsts])
    first = np.concatenate(firsts).astype(np.int64)
    step = np.arange(LENGTH)
    data = np.empty((len(first), LENGTH, 2))
    use = np.empty((len(first), LENGTH, 2), dtype=bool)
    for k, (r, f) in enumerate(zip(run_of, first, strict=True)):
        data[k, :, 0], data[k, :, 1] = runs[r].raw_u[f + step], runs[r].raw_F[f + step]
        use[k] = ~runs[r].bad[f + step]
    use[:, :BURN] = False
    if runs[0].setup.system is System.LINEAR_DRIVE:
        use[..., 1] = False  # the force drives there, it isn't predicted
        use[:, BURN + max(FEWEST, round(LASTS / runs[0].dt)) :] = False
    held = np.concatenate([(np.arange(len(f)) // 2) % 2 == 1 for f in firsts]) if len(firsts) else np.zeros(0, bool)
    return Windows(run_of.astype(np.int64), first, data, use, held)


def _smooth_starts(run: Run) -> Index:
    """Samples from which a window can begin: taut, no impact within 16 samples, not too near the ends."""
    n = len(run.raw_u)
    reach = half(run.dt, SMOOTH)
    places = np.arange(max(40, reach), n - max(LENGTH + 24, reach))
    if len(places) <= 0:
        return np.zeros(0, np.int64)
    _, _, left_u = polynomial(run.raw_u, places, reach, 4, run.dt)
    good = (left_u < 1.6 * run.noise_u) & (run.u.value[places] < _ceiling(run))
    good &= ~(np.convolve(run.bad.any(axis=1), np.ones(2 * CLEAR + 1), "same") > 0.5)[places]
    if run.setup.system is System.WF:
        good &= (places > _released(run)) | (places + LENGTH < round(REST / run.dt))
    if run.setup.system is System.WFPD:
        value, _, left = polynomial(run.raw_F, places, reach, 4, run.dt)
        low = np.min(np.lib.stride_tricks.sliding_window_view(run.F.value, 2 * reach + 1)[places - reach], axis=1)
        limit = 1.6 * run.noise_F + 0.004 * np.abs(value)
        taut = np.minimum(4.0, 0.3 * abs(run.rest_force))
        good &= (left < limit) & (low > taut) & _stretched(run)[places]
    chosen: Index = places[good]
    return chosen


def _stretched(run: Run) -> NDArray[np.bool_]:
    """Where the fibre may be taut by x, u and the rest force: a gauge that drifts shows force where there is none.

    A force beyond that at rest is believed: then it is x or u that is off.
    """
    stretch = run.x.value - run.u.value + run.rest_force / run.setup.fibre_stiffness
    doubt = SLACK[0] + SLACK[1] * np.abs(run.u.rate) + SLACK[2] * np.abs(run.u.value)
    taut: NDArray[np.bool_] = (stretch > -doubt) | (run.F.value > run.rest_force)
    return taut


def _released(run: Run) -> int:
    """The last sample at which the weight is held up by something that no model knows: high, still, the fibre slack."""
    high = run.u.value > 0.8 * float(np.max(run.u.value))
    held = high & (np.abs(run.u.rate) < 0.01) & (run.F.value < 0.25 * abs(run.rest_force))
    places = np.flatnonzero(held)
    return int(places[-1]) + CLEAR if len(places) else 0


def _ceiling(run: Run) -> float:
    """Where u stands at its highest for long, no window starts: a stop or a gauge at its limit hides the state
    there.
    """
    top = float(np.quantile(run.raw_u, 0.9995))
    standing = float(np.mean(run.raw_u > top - 8 * run.noise_u))
    return top - 12 * run.noise_u if standing > 0.005 else np.inf


def _spread(run: Run, starts: Index, count: int) -> Index:
    """A few of `starts`: evenly over the run's motion, hardly any of its rest."""
    if len(starts) == 0:
        return starts
    lively = np.add.reduceat(run.moving.astype(float), np.arange(0, len(run.moving), 1))
    active = np.convolve(lively, np.ones(LENGTH) / LENGTH, "valid")[starts] > 0.3
    chosen = _evenly(starts[active], count)
    calm = _evenly(starts[~active], 1 if len(chosen) >= count // 2 else 3)
    return np.sort(np.concatenate([chosen, calm])).astype(np.int64)


def _evenly(starts: Index, count: int) -> Index:
    if len(starts) == 0:
        return starts
    spaced = [int(starts[0])]
    for s in starts:
        if s >= spaced[-1] + 60:
            spaced.append(int(s))
    pick = np.unique(np.linspace(0, len(spaced) - 1, min(count, len(spaced))).round().astype(int))
    picked: Index = np.array(spaced, dtype=np.int64)[pick]
    return picked
