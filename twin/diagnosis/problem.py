"""Windows simulated from their reconstructed starts: predictions, their sensitivities, and what they leave."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stand.setup import System
from twin.causes._kind import Undo
from twin.diagnosis.composition import Composition, Hooks
from twin.diagnosis.coordinates import STATED
from twin.diagnosis.kept import Kept
from twin.diagnosis.measured import measured_path
from twin.diagnosis.run import LENGTH, REST, Run, Windows, half
from twin.diagnosis.shared import shared, spread
from twin.diagnosis.smooth import ahead, curvature, gains, polynomial
from twin.kernels import composed, composed_sense
from twin.kernels import composed_slots as k

Float = NDArray[np.float64]
Index = NDArray[np.int64]
DEGREE = 4
FINE = 5e-4  # s between samples at which local polynomials follow any motion of a stand
#: a start's rim: displaced so far to feel its stiffness, moved no farther at once nor more often, and settled, m
NUDGE, FARTHEST, BALANCED, SETTLED = 2e-6, 1e-3, 5, 1e-9


@dataclass
class Problem:
    """Runs and their windows; keeps what depends on few parameters only."""

    runs: tuple[Run, ...]
    windows: Windows
    _kept: Kept = field(default_factory=Kept)

    def __post_init__(self) -> None:
        self.system = self.runs[0].setup.system
        self.dt = self.runs[0].dt
        lengths = [len(r.raw_u) for r in self.runs]
        self.offset = np.concatenate([[0], np.cumsum(lengths)[:-1]]).astype(np.int64)
        self.drive = np.ascontiguousarray(np.concatenate([np.column_stack([r.x.value, r.x.rate]) for r in self.runs]))
        self.smooth = np.ascontiguousarray(
            np.concatenate([np.column_stack([r.u.value, r.u.rate, r.F.value, r.F.rate]) for r in self.runs])
        )
        self._polynomials()
        self.sigma = np.array([[self._sigma(r), r.noise_F] for r in self.runs])[self.windows.run]

    def __reduce__(self) -> tuple[Any, ...]:
        return Problem, (self.runs, self.windows)  # what is kept stays at home

    def _sigma(self, run: Run) -> float:
        """One sigma of a place: the gauge's, and on an axis what the measured force's own noise adds until half-way."""
        if self.system is not System.LINEAR_DRIVE:
            return run.noise_u
        span = 0.5 * self.dt * float(self.windows.use[..., 0].sum(axis=1).max(initial=0))
        force = run.noise_F / (run.setup.moving_mass or 1.0)
        return float(np.hypot(run.noise_u, force * np.sqrt(self.dt * span**3 / 3)))

    def _polynomials(self) -> None:
        """How far each start may lie from where local polynomials put it; at low rates these are biased, too."""
        w = self.windows
        self.spread = np.empty((len(w), 4))
        for r, run in enumerate(self.runs):
            mine = w.run == r
            value, rate = gains(half(self.dt), DEGREE, self.dt)
            coarse = max(1.0, (self.dt / FINE) ** 2)
            self.spread[mine] = (
                max(run.noise_u * value, 3e-7) * coarse,
                1.5 * run.noise_u * rate * coarse,
                15e-6,
                0.03,
            )

    def part(self, keep: NDArray[Any]) -> Problem:
        """The same runs with some of the windows."""
        return Problem(self.runs, self.windows.part(keep))

    @property
    def data(self) -> Float:
        """[w, LENGTH, 2]."""
        return self.windows.data

    def predict(self, model: Composition, z: Float, starts: Float) -> Float:
        """What the gauges would have told, [w, LENGTH, 2]; starts [w, 4]: from the reconstruction, in `spread`s.

        The last prediction is kept: a fit asks for it twice.
        """
        asked = "prediction", id(model), z.tobytes(), starts.tobytes()
        told, _ = self._kept.keep(asked, 1, lambda: (self.sense(model, z, self.simulate(model, z, starts)[0]), model))
        return told

    def simulate(self, model: Composition, z: Float, starts: Float) -> tuple[Float, NDArray[np.int64]]:
        """True signals [w, LENGTH, 5] and each window's status."""
        undo = model.undo(z)
        constants = self._constants(model, z, undo)
        drive = self._driven(model, z)
        before, after = model.hooks(z, "before"), model.hooks(z, "after")
        own = self._own(model, z, constants, drive, undo, before, after)
        centre = self._centres(model, z, constants, drive, before, after, own)
        state = np.ascontiguousarray(centre + starts * self.spread)
        return self._carry(state, own, constants, drive, before, after, LENGTH)

    def _constants(self, model: Composition, z: Float, undo: Undo) -> Float:
        """Every run's constants; they hang on the base values and the true rest forces alone."""
        rest = [(r.rest_force - undo.F_offset - undo.F_rate * 0.5 * REST) / undo.F_gain for r in self.runs]
        stated = tuple(float(v) for v, c in zip(z, model.coordinates, strict=True) if c.owner in STATED)
        key = ("constants", model.names, stated, tuple(rest))
        return self._kept.keep(key, 5, lambda: model.constants(z, rest))

    def forget_states(self) -> None:
        """Drops the causes' own states, which hang a little on the base values at which they were had first."""
        self._kept.forget("own")
        self._kept.forget("prediction")

    def sense(self, model: Composition, z: Float, simulated: Float) -> Float:
        """The gauges' readings of simulated windows."""
        hooks, out = model.hooks(z, "senses"), np.empty((len(self.windows), LENGTH, 2))
        late = model.base_value(z, "late_u"), model.base_value(z, "late_F")
        w = self.windows
        spread(
            len(w),
            LENGTH,
            lambda a, b: composed_sense.sense(
                simulated[a:b], w.run[a:b], w.first[a:b], self.dt, *late, hooks.address, hooks.p, out[a:b]
            ),
        )
        return out

    def _driven(self, model: Composition, z: Float) -> Float:
        """x, x' at the fibre's end, all runs."""
        hooks = model.hooks(z, "moves")
        if not len(hooks.address):
            return self.drive
        key = ("drive", hooks.address.tobytes(), hooks.p.tobytes())
        return self._kept.keep(key, 1, lambda: self._moved(hooks))

    def _moved(self, hooks: Hooks) -> Float:
        parts = []
        for r in self.runs:
            x, speed = r.x.value.copy(), r.x.rate.copy()
            composed_sense.drive_end(x, speed, self.dt, hooks.address, hooks.p)
            parts.append(np.column_stack([x, speed]))
        return np.ascontiguousarray(np.concatenate(parts))

    def _own(
        self, model: Composition, z: Float, constants: Float, drive: Float, undo: Undo, before: Hooks, after: Hooks
    ) -> Float:
        """The causes' own states at the starts, from their history along the measured motion.

        Kept by the causes' values, freed base values among them: what a small step of another base value does to a
        history, which moves the rim a little, is left out of the columns.
        """
        own = np.zeros((len(self.windows), k.STATES))
        if not model.own_states or self.system is System.LINEAR_DRIVE:
            return own

        def fill() -> Float:
            runs = range(len(self.runs))
            shared(
                [partial(self._history, not model.slides, r, own, constants, drive, undo, before, after) for r in runs]
            )
            return own

        values = tuple(v for c in model.causes for v in model.values(z, c).values())
        return self._kept.keep(("own", model.names, values), len(values) + 6, fill)

    def _history(
        self, coasts: bool, r: int, own: Float, constants: Float, drive: Float, undo: Undo, before: Hooks, after: Hooks
    ) -> None:
        run, mine = self.runs[r], self.windows.run == r
        if not mine.any():
            return
        last = int(self.windows.first[mine].max()) + 2
        ends = drive[self.offset[r] : self.offset[r] + last]
        share = float(constants[r, k.K_C1] / (constants[r, k.K_C1] + constants[r, k.K_C2]))
        path, force, _ = self._kept.keep(
            ("path", r, last, id(drive), share, undo),
            len(self.runs),
            lambda: (*measured_path(run, ends, share, undo, last), drive),
        )
        out = np.empty((last, k.STATES))
        composed.history(
            path, force, ends, constants[r], np.zeros((1, k.STATES)), self.dt,
            before.address, before.p, after.address, after.p, int(coasts), out,
        )  # fmt: skip
        own[mine] = out[self.windows.first[mine]]

    def _centres(
        self, model: Composition, z: Float, constants: Float, drive: Float, before: Hooks, after: Hooks, own: Float
    ) -> Float:
        """Each window's start (u, v, s, w) as its instruments, inverted, tell it."""
        undo, w = model.undo(z), self.windows
        at = self.offset[w.run] + w.first
        time: Float = w.first.astype(np.float64) * self.dt
        u, v = self._around(0, undo.u_late + undo.u_drift * time, undo.u_lag)
        v_true = v / undo.u_gain
        u_true = (u + undo.u_side * np.clip(v / 0.002, -1, 1)) / undo.u_gain
        centre = np.zeros((len(w), 4))
        centre[:, 0], centre[:, 1] = u_true, v_true
        if self.system is not System.WFPD:
            return centre
        F, Fd = self._around(1, undo.F_late + undo.F_drift * time, undo.F_lag)
        acceleration = (drive[at + 1, 1] - drive[at - 1, 1]) / (2 * self.dt)
        F = (F - undo.F_offset - undo.F_rate * time - undo.F_mass * acceleration) / undo.F_gain
        c = constants[w.run]
        rate = Fd / undo.F_gain / c[:, k.K_C2]
        centre[:, 3] = drive[at, 1] - rate
        centre[:, 2] = drive[at, 0] + c[:, k.K_REST] / c[:, k.K_C2] - (F - c[:, k.K_B2] * rate) / c[:, k.K_C2]
        if len(before.address):
            self._balance(centre, F, rate, c, lambda: self._carry(centre, own, constants, drive, before, after, 1)[0])
        return centre

    def _balance(self, centre: Float, F: Float, rate: Float, c: Float, carried: Callable[[], Float]) -> None:
        """Moves s and w, in place, to where the strand as the causes change it pulls as measured, and as fast.

        rate: F' over the strand's stated stiffness, m/s. carried: the starts' first sample as it would be.
        """
        missed = carried()[:, 0, 2] - F
        centre[:, 2] += NUDGE
        stiff = (missed + F - carried()[:, 0, 2]) / NUDGE
        centre[:, 2] -= NUDGE
        felt = (stiff > 0.05 * c[:, k.K_C2]) & (stiff < 20.0 * c[:, k.K_C2])  # neither slack nor sliding there
        stiff = np.where(felt, stiff, c[:, k.K_C2])
        centre[:, 3] += rate - rate * c[:, k.K_C2] / stiff
        for _ in range(BALANCED):
            move = np.clip(missed / stiff, -FARTHEST, FARTHEST)
            centre[:, 2] += move
            now = carried()[:, 0, 2] - F
            better = np.abs(now) < np.abs(missed)
            centre[~better, 2] -= move[~better]
            missed, stiff = np.where(better, now, missed), np.where(better, stiff, 3.0 * stiff)
            if float(np.max(np.abs(missed / stiff), initial=0.0)) < SETTLED:
                break

    def _around(self, channel: int, late: Float, lag: float) -> tuple[Float, Float]:
        """A channel's smooth value and rate at the starts, `late` s further on and a lag undone: between the local
        polynomials of the two samples about that moment, so that nothing jumps where the nearer one changes.
        """
        places = np.floor(late / self.dt).astype(np.int64)
        share = late / self.dt - places
        before, after = self._local(channel, places), self._local(channel, places + 1)
        value, rate, second = (
            (1.0 - share) * a + share * b
            for a, b in zip(ahead(before, share * self.dt), ahead(after, (share - 1.0) * self.dt), strict=True)
        )
        return value + lag * rate, rate + lag * second

    def _local(self, channel: int, places: Index) -> tuple[Float, Float, Float]:
        """Value, rate and second derivative about samples `places` after the starts; kept."""
        return self._kept.keep((f"local {channel}", places.tobytes()), 16, lambda: self._fit(channel, places))

    def _fit(self, channel: int, shift: Index) -> tuple[Float, Float, Float]:
        w = self.windows
        value, rate, second = np.empty(len(w)), np.empty(len(w)), np.empty(len(w))
        for r, run in enumerate(self.runs):
            mine = w.run == r
            raw = run.raw_u if channel == 0 else run.raw_F
            reach = half(self.dt)
            places = np.clip(w.first[mine] + shift[mine], 2 * reach, len(raw) - 2 * reach - 1)
            value[mine], rate[mine], _ = polynomial(raw, places, reach, DEGREE, self.dt)
            second[mine] = curvature(raw, places, 2 * reach, self.dt)
        return value, rate, second

    def _carry(
        self, state: Float, own: Float, constants: Float, drive: Float, before: Hooks, after: Hooks, length: int
    ) -> tuple[Float, NDArray[np.int64]]:
        w = self.windows
        out, status = np.empty((len(w), length, 5)), np.zeros(len(w), np.int64)
        spread(
            len(w),
            length,
            lambda a, b: composed.windows(
                state[a:b], own[a:b], constants, w.run[a:b], w.first[a:b], length, drive, self.dt,
                before.address, before.p, after.address, after.p, self.offset, out[a:b], status[a:b],
            ),
        )  # fmt: skip
        return out, status


__all__ = ["Problem"]
