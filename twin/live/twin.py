"""The model beside the run, from the streamed drive position."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable, Mapping
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError, StandError
from stand.setup import Setup, System
from twin.live.channel import ChannelTrack
from twin.live.columns import Columns
from twin.live.score import LiveScore
from twin.live.short import ShortWindows
from twin.model import FibreModel, Start, Status
from twin.simulate import check_system, first_force

Float = NDArray[np.float64]

#: s of rest at the beginning from which the zeros of u and x are taken
REST = 0.4
#: s between two searches for the lag
LAG_EVERY = 0.25


class LiveTwin:
    """Simulates u and F from blocks of x as they come and scores them against the measured u and F.

    The first 0.4 s are kept until the zeros are known, then simulated with the rest. What never came is bridged
    in x by a cubic, counted as dropped and not scored.
    """

    def __init__(
        self,
        setup: Setup,
        model: FibreModel,
        parameters: Mapping[str, float] | None = None,
        *,
        dt: float = 1.0 / 2000.0,
        window: float = 2.0,
        now: Callable[[], float] = clock.monotonic,
    ) -> None:
        check_system(model, setup)
        if setup.system is not System.WFPD:
            raise InputError("no live twin without a drive", value=str(setup.system), remedy="Use `stand compare`")
        self.setup, self.model, self.dt, self._now = setup, model, dt, now
        model.warm()
        self._constants = model.constants(setup, parameters or {})
        self._raw = Columns("time", "x", "u", "F")
        self._made = Columns("u", "F")
        self._tracks = (ChannelTrack(round(window / dt), dt), ChannelTrack(round(window / dt), dt))
        self._short = ShortWindows(setup, model, self._constants, dt)
        self._state: Float | None = None
        self._drive = np.zeros((1, 2))
        self._zero, self.dropped, self._gaps = (0.0, 0.0), 0, [0]
        self._busy, self._lagged, self._turn = 0.0, 0.0, 0

    def push(self, time: Float, x: Float, u: Float, F: Float, newest_arrival: float | None = None) -> LiveScore:
        """Takes one block on the uniform grid (s, m, m, N; [n] each) and returns the scores after it.

        InputError where the block is not on the grid; StandError where the model gave up.
        """
        began = self._now()
        self._take(np.asarray(time), np.asarray(x), np.asarray(u), np.asarray(F))
        first = self._made.count
        self._advance(self._raw.count - 2)
        self._score_new(first)
        ended = self._now()
        self._busy += ended - began
        return self._report(first, ended - newest_arrival if newest_arrival is not None else math.nan)

    def finish(self) -> LiveScore:
        """Simulates the last two samples too, whose slopes had waited for a successor."""
        first = self._made.count
        self._advance(self._raw.count)
        self._score_new(first)
        for track in self._tracks:
            if self._made.count > 8:
                track.update_lag()
        return self._report(first, math.nan)

    def samples(self) -> dict[str, Float]:
        """What was used and what came out: time, x, u, F, simulated_u, simulated_F, [n] each; zeros taken off."""
        n = self._made.count
        used = {name: self._raw[name][:n].copy() for name in ("time", "x", "u", "F")}
        return used | {"simulated_u": self._made["u"].copy(), "simulated_F": self._made["F"].copy()}

    def _take(self, time: Float, x: Float, u: Float, F: Float) -> None:
        if not len(time) == len(x) == len(u) == len(F):
            sizes = (len(time), len(x), len(u), len(F))
            raise InputError("channels of unequal length", where="live twin", value=sizes)
        if self._raw.count and len(time):
            missing = round((time[0] - self._raw["time"][-1]) / self.dt) - 1
            if missing < 0:
                raise InputError("time goes back", where="live twin", value=float(time[0]), remedy="Push in order")
            self.dropped += missing
            if missing:
                self._gaps.append(self._raw.count)
        self._raw.append(time, x - self._zero[0], u - self._zero[1], F)
        if self._state is None and self._raw.count >= round(REST / self.dt):
            self._begin()

    def _begin(self) -> None:
        """Zeros from the rest; the model hangs at rest."""
        rest = round(REST / self.dt)
        self._zero = (float(np.median(self._raw["x"][:rest])), float(np.median(self._raw["u"][:rest])))
        self._raw.shift("x", -self._zero[0])
        self._raw.shift("u", -self._zero[1])
        self._drive = np.array([[self._raw["x"][0], 0.0]])
        self._state = np.asarray(self.model.start(self._constants, Start(x=float(self._drive[0, 0]))))

    def _advance(self, end: int) -> None:
        """Simulates up to sample `end` (not included)."""
        if self._state is None or end <= self._made.count:
            return
        if self._made.count == 0:
            force = first_force(self.model, self._constants, self._state, self._drive[0], self.dt)
            self._made.append(self._state[:1], np.array([force]))
        for begin, stop in self._stretches(self._made.count, end):
            self._carry(begin, stop)

    def _stretches(self, begin: int, end: int) -> list[tuple[int, int]]:
        """[begin, end) cut where samples are missing."""
        cuts = [begin, *(gap for gap in self._gaps if begin < gap < end), end]
        return list(pairwise(cuts))

    def _carry(self, begin: int, stop: int) -> None:
        from twin.kernels.hermite import slopes

        whole = max(gap for gap in self._gaps if gap <= begin)
        low = max(begin - 4, whole)
        high = min([self._raw.count, stop + 2, *(gap for gap in self._gaps if gap > begin)])
        slope = slopes(self._raw["x"][low:high], self.dt)[begin - low : stop - low]
        table = np.column_stack((self._raw["x"][begin:stop], slope))
        time = self._raw["time"]
        if begin in self._gaps and begin > 0:
            missing = round((time[begin] - time[begin - 1]) / self.dt) - 1
            self._run(bridge(self._drive[0], table[0], missing, self.dt), keep=1)
            table, self._drive = table[1:], table[:1].copy()
        if len(table):
            self._run(np.vstack((self._drive, table)), keep=len(table))
            self._drive = table[-1:].copy()

    def _run(self, drive: Float, keep: int) -> None:
        assert self._state is not None
        out = np.empty((len(drive) - 1, 3))
        status = self.model.advance(self._constants, self._state, np.ascontiguousarray(drive), self.dt, out)
        if status != Status.THE_MODEL_REACHED_THE_LAST_SAMPLE:
            raise StandError(Status(status).sentence, where=f"live twin, model {self.model.name}")
        self._made.append(out[-keep:, 0], out[-keep:, 2])

    def _score_new(self, first: int) -> None:
        last = self._made.count
        if last == first:
            return
        for track, name in zip(self._tracks, ("u", "F"), strict=True):
            track.push(self._raw[name][first:last], self._made[name][first:last])
        self._short.follow(self._raw, self._gaps)
        if (last * self.dt) - self._lagged >= LAG_EVERY / 2:
            self._lagged, self._turn = last * self.dt, 1 - self._turn
            self._tracks[self._turn].update_lag()

    def _report(self, first: int, latency: float) -> LiveScore:
        last, load = self._made.count, self._busy / max(self._raw.count * self.dt, 1e-9)
        notes = [f"{self.dropped} samples never reached the twin"] if self.dropped else []
        if load > 1.0:
            notes.append(f"the twin falls behind: it needs {load:.1f} s for each second of the run")
        return LiveScore(
            first=first,
            time=self._raw["time"][first:last].copy(),
            simulated_u=self._made["u"][first:last].copy(),
            simulated_F=self._made["F"][first:last].copy(),
            u=self._tracks[0].score(self._short.u),
            F=self._tracks[1].score(self._short.F),
            samples=last,
            dropped=self.dropped,
            short_windows=self._short.u.count,
            passed_over=self._short.passed_over,
            load=load,
            latency=latency,
            notes=tuple(notes),
        )


def bridge(before: Float, after: Float, missing: int, dt: float) -> Float:
    """x and x' at the grid over a gap, [missing + 2, 2]: one cubic from the last sample to the next."""
    span = (missing + 1) * dt
    p = np.linspace(0.0, 1.0, missing + 2)
    h = after[0] - before[0]
    a2, a3 = 3 * h - span * (2 * before[1] + after[1]), span * (before[1] + after[1]) - 2 * h
    x = before[0] + p * (span * before[1] + p * (a2 + p * a3))
    return np.column_stack((x, (span * before[1] + p * (2 * a2 + 3 * p * a3)) / span))
