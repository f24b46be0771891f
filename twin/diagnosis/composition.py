"""A model with causes in it, as the arrays that the composed stepper needs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stand.setup import Setup, System
from twin.causes._kind import Cause, Undo
from twin.diagnosis.coordinates import STATED, Coordinate, base, of_cause, offsets
from twin.kernels import composed_slots as k

Float = NDArray[np.float64]
WIDTH = 96
_SYSTEM = {System.WFPD: k.WFPD, System.WF: k.WF, System.LINEAR_DRIVE: k.AXIS}


@dataclass(frozen=True)
class Hooks:
    """Addresses int64 [h] and constants float64 [h, WIDTH] of one kind of hook."""

    address: NDArray[np.int64]
    p: Float


@dataclass(frozen=True)
class Composition:
    """The base model of some runs' setups with causes; z stands in the order of `coordinates`."""

    setups: tuple[Setup, ...]
    causes: tuple[Cause, ...]

    @cached_property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Base values, runs' offsets, then the causes' parameters."""
        freed = frozenset(c.base for c in self.causes if c.base is not None)
        found = base(self.setups, freed, frozenset(self.names))
        if self.setups[0].system is System.WFPD:
            found += offsets(len(self.setups), any(c.rest_free for c in self.causes))
        for cause in self.causes:
            found += of_cause(cause)
        return found

    @cached_property
    def index(self) -> dict[tuple[str, str], int]:
        """Place of (owner, name) in z, runs' offsets apart."""
        return {(c.owner, c.name): i for i, c in enumerate(self.coordinates) if c.run < 0}

    @cached_property
    def low(self) -> Float:
        """The coordinates' lower bounds."""
        return np.array([c.low for c in self.coordinates])

    @cached_property
    def high(self) -> Float:
        """Their upper bounds."""
        return np.array([c.high for c in self.coordinates])

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The causes' names."""
        return tuple(c.name for c in self.causes)

    def zero(self) -> Float:
        """The setup as stated, and every cause at null."""
        return np.zeros(len(self.coordinates))

    def unbent(self, z: Float) -> Float:
        """z with the setup's values and the runs' zeros as stated; what a cause has freed stays where it is."""
        bent = np.array([c.owner in STATED and np.isfinite(c.prior) for c in self.coordinates])
        return np.where(bent, 0.0, z)

    def values(self, z: Float, cause: Cause) -> dict[str, float]:
        """A cause's parameters by name, SI; a phase between -pi and pi."""
        if cause.base is not None:
            return {"difference": self.base_value(z, cause.base)}
        found = {}
        for p in cause.parameters:
            i = self.place(cause, p.name)
            value = self.coordinates[i].value(float(z[i]))
            found[p.name] = math.remainder(value, math.tau) if p.unit == "rad" else value
        return found

    def place(self, cause: Cause, parameter: str) -> int:
        """Where in z a cause's parameter stands; of a cause that frees a base value, that one's place."""
        return self.index["base", cause.base] if cause.base is not None else self.index[cause.name, parameter]

    def base_value(self, z: Float, name: str) -> float:
        """How far a base value is from the setup's, in its unit (SI)."""
        i = self.index.get(("base", name))
        return 0.0 if i is None else self.coordinates[i].value(float(z[i]))

    def put(self, z: Float, cause: Cause, values: Mapping[str, float]) -> Float:
        """z with a cause's parameters set."""
        z = z.copy()
        for name, value in values.items():
            i = self.place(cause, name)
            c = self.coordinates[i]
            z[i] = (value - c.origin) / c.scale
        return z

    def carry(self, z: Float, other: Composition) -> Float:
        """This model's z as the other model's, where they share coordinates."""
        mine = {(c.owner, c.name, c.run): float(v) for c, v in zip(self.coordinates, z, strict=True)}
        return np.array([mine.get((c.owner, c.name, c.run), 0.0) for c in other.coordinates])

    def setup(self, z: Float, run: int) -> Setup:
        """One run's setup with calibrated values in it."""
        s = self.setups[run]
        if s.system is System.LINEAR_DRIVE:
            return s.with_values(moving_mass=max((s.moving_mass or 1.0) + self.base_value(z, "moving_mass"), 1e-3))
        split = self.base_value(z, "split")
        free = s.free_length
        first = s.weight_strand_length * math.exp(split * s.drive_strand_length / free) if free else 0.0
        return s.with_values(
            weight_mass=max(s.weight_mass + self.base_value(z, "weight_mass"), 0.05),
            added_mass=max(s.added_mass + (self.base_value(z, "added_mass") if s.added_mass > 0 else 0.0), 0.0),
            incline_angle=s.incline_angle + self.base_value(z, "incline_angle"),
            fibre_stiffness=max(s.fibre_stiffness + self.base_value(z, "fibre_stiffness"), 100.0),
            fibre_damping=max(s.fibre_damping + self.base_value(z, "fibre_damping"), 0.0),
            pulley_inertia=max(s.pulley_inertia + self.base_value(z, "pulley_inertia"), 1e-6),
            guide_friction=max(s.guide_friction + self.base_value(z, "guide_friction"), 0.0),
            guide_friction_velocity=s.guide_friction_velocity * math.exp(self.base_value(z, "guide_friction_velocity")),
            weight_strand_length=first if s.drive_strand_length else s.weight_strand_length,
            drive_strand_length=free - first if s.drive_strand_length else 0.0,
        )

    def constants(self, z: Float, rest: Sequence[float]) -> Float:
        """[runs, CONSTANTS]; rest: each run's true rest tension, N."""
        rows = {first: self._row(z, first) for first in set(self._alike)}
        found = np.array([rows[first] for first in self._alike])
        if self.setups[0].system is System.WFPD:
            found[:, k.K_REST] = rest
        for i, c in enumerate(self.coordinates):
            if c.owner == "run":
                found[c.run, k.K_OFFSET] = c.value(float(z[i]))
        return found

    @cached_property
    def _alike(self) -> tuple[int, ...]:
        """Of each run, the first with the same setup but for the measured friction, which has no part here."""
        plain = [s.with_values(guide_friction_curve=None) for s in self.setups]
        return tuple(plain.index(s) for s in plain)

    def _row(self, z: Float, run: int) -> Float:
        """What hangs on a run's setup."""
        s = self.setup(z, run)
        row = np.zeros(k.CONSTANTS)
        row[k.K_SYSTEM] = _SYSTEM[s.system]
        row[k.K_OWN] = self.own_states
        if s.system is System.LINEAR_DRIVE:
            row[[k.K_MASS, k.K_VS, k.K_C1, k.K_C2]] = s.moving_mass, 0.002, 1.0, 1.0
            row[k.K_FC] = max(self.base_value(z, "guide_friction"), 0.0)
            return row
        free = s.free_length
        share = [free / s.weight_strand_length, free / s.drive_strand_length if s.drive_strand_length else 1.0]
        row[[k.K_C1, k.K_C2]] = np.array(share) * s.fibre_stiffness
        row[[k.K_B1, k.K_B2]] = np.array(share) * s.fibre_damping
        row[[k.K_MASS, k.K_WEIGHT]] = s.mass, s.rest_tension
        row[k.K_RIM] = s.pulley_inertia / s.pulley_radius**2
        row[[k.K_FC, k.K_VS]] = s.guide_friction, s.guide_friction_velocity
        row[[k.K_REST, k.K_RADIUS]] = s.rest_tension, s.pulley_radius
        return row

    def hooks(self, z: Float, kind: str) -> Hooks:
        """The causes' hooks of a kind (before, after, senses, moves) with their constants."""
        axis = self.setups[0].system is System.LINEAR_DRIVE  # there the gauge's force is what drives
        skip = {"senses": axis, "moves": not axis}.get(kind, False)
        able = [c for c in self.causes if getattr(c, kind) is not None and not (skip and c.acts_on == "force-gauge")]
        chosen = sorted(able, key=lambda c: c.order)
        p = np.zeros((max(len(chosen), 1), WIDTH))
        if chosen:
            own, setup = self._own(), self.setup(z, 0)
            for row, cause in zip(p, chosen, strict=True):
                packed = cause.pack(setup, self.values(z, cause), own[cause.name])
                row[: len(packed)] = packed
        return Hooks(np.array([getattr(c, kind).address for c in chosen], dtype=np.int64), p)

    def _own(self) -> dict[str, int]:
        own, place = {}, 0
        for cause in self.causes:
            own[cause.name] = place
            place += cause.states
        if place > k.STATES:
            raise ValueError(f"{place} states of causes; {k.STATES} fit")
        return own

    @property
    def slides(self) -> bool:
        """Whether the fibre may slide on the rim."""
        return any(c.slides for c in self.causes)

    @property
    def own_states(self) -> int:
        """How many states the causes have of their own."""
        return sum(c.states for c in self.causes)

    def undo(self, z: Float) -> Undo:
        """All instruments' inverses together."""
        parts = [c.undo(self.values(z, c)) for c in self.causes]
        return Undo(
            u_late=sum(p.u_late for p in parts) + self.base_value(z, "late_u"),
            u_drift=sum(p.u_drift for p in parts),
            u_lag=sum(p.u_lag for p in parts),
            u_gain=math.prod(p.u_gain for p in parts),
            u_side=sum(p.u_side for p in parts),
            F_late=sum(p.F_late for p in parts) + self.base_value(z, "late_F"),
            F_drift=sum(p.F_drift for p in parts),
            F_lag=sum(p.F_lag for p in parts),
            F_gain=math.prod(p.F_gain for p in parts),
            F_offset=sum(p.F_offset for p in parts),
            F_rate=sum(p.F_rate for p in parts),
            F_mass=sum(p.F_mass for p in parts),
        )
