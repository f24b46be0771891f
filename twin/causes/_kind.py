"""What a cause is: one way in which reality may differ from the operator's force model."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from numba import cfunc

from stand.setup import Setup, System
from twin.kernels.composed_call import DYNAMICS, INPUT, SENSOR
from twin.parameter import Parameter, Source
from twin.plugins import load

Values = Mapping[str, float]
dynamics = cfunc(DYNAMICS, cache=True)
sensor = cfunc(SENSOR, cache=True)
drive_input = cfunc(INPUT, cache=True)

WFPD = frozenset({System.WFPD})
FIBRE = frozenset({System.WFPD, System.WF})
GUIDE = frozenset(System)


@dataclass(frozen=True)
class Undo:
    """How a true signal is had from a recorded one, to first order, where a window starts.

    true u(t) = (y(t + u_late) + u_lag y'(t + u_late) + u_side sign(u')) / u_gain, y the record, and u_late grows by
    u_drift each second;
    true F(t) = (y(t + F_late) + F_lag y'(t + F_late) - F_offset - F_rate t - F_mass x'') / F_gain.
    """

    u_late: float = 0.0
    u_drift: float = 0.0
    u_lag: float = 0.0
    u_gain: float = 1.0
    u_side: float = 0.0
    F_late: float = 0.0
    F_drift: float = 0.0
    F_lag: float = 0.0
    F_gain: float = 1.0
    F_offset: float = 0.0
    F_rate: float = 0.0
    F_mass: float = 0.0


@dataclass(frozen=True)
class Survey:
    """What the recordings reach, where a scan has to begin: ranges of u, x [m], F [N], |u'| [m/s], and seconds.

    often: where u is for nine tenths of the time; a thrown weight goes far beyond.
    """

    u: tuple[float, float]
    often: tuple[float, float]
    x: tuple[float, float]
    F: tuple[float, float]
    speed: float
    seconds: float
    noise_u: float
    noise_F: float


def plain(setup: Setup, values: Values, own: int) -> Sequence[float]:
    """A hook's constants: the first of the cause's own states, then its parameters in their order."""
    return (float(own), *values.values())


def strands(setup: Setup, values: Values, own: int) -> Sequence[float]:
    """As `plain`, then c_i/c of the weight's and of the drive's strand, then the fibre's whole length, m."""
    free = setup.free_length
    drive = free / setup.drive_strand_length if setup.drive_strand_length > 0 else 0.0
    return (*plain(setup, values, own), free / setup.weight_strand_length, drive, setup.fibre_length)


def no_undo(values: Values) -> Undo:
    """Nothing to undo."""
    return Undo()


@dataclass(frozen=True)
class Cause:
    """One way in which reality may differ: nothing changes while its first parameter is at its null value.

    acts_on: verdict.md's word. parameters: value is the null (no effect) or, after the first, where a search may
        begin; uncertainty is a size that would be typical. base: the setup's value that this cause frees, if it does.
    before, after: hooks of the dynamics, at their places in `composed_slots`. senses: hook on the gauges' signals.
        moves: hook on the drive's recorded position. states: how many states of its own it has. slides: the rim may
        turn under the fibre.
    pack: (setup, values, first own state) -> the hooks' constants. undo: how its instrument is inverted at a start.
    scan: what is nonlinear is tried at these values. rivals: causes that look alike. late: order among sensor hooks.
    variants: of a cause of one among several signals or instruments; each has that `choice` under `key`. rest_free:
    the zero of x is lost too.
    """

    name: str
    title: str
    acts_on: str
    parameters: tuple[Parameter, ...]
    source: Source
    how: str = "dynamics"
    base: str | None = None
    before: Any = None
    after: Any = None
    senses: Any = None
    moves: Any = None
    states: int = 0
    slides: bool = False
    order: int = 0
    pack: Callable[[Setup, Values, int], Sequence[float]] = plain
    undo: Callable[[Values], Undo] = no_undo
    scan: Callable[[Survey], Sequence[Values]] | None = None
    rivals: tuple[str, ...] = ()
    systems: frozenset[System] = FIBRE
    rest_free: bool = False
    key: str | None = None
    choice: str | None = None
    variants: tuple[Cause, ...] = ()

    def __reduce__(self) -> tuple[Any, ...]:
        return named, (self.name,)  # hooks are addresses in this process: elsewhere the catalogue has its own

    @property
    def null(self) -> dict[str, float]:
        """Every parameter at its null or first value."""
        return {p.name: p.value for p in self.parameters}

    def trials(self, survey: Survey) -> Sequence[Values]:
        """Where a search begins: the scan's points, or the typical size on either side of null."""
        if self.scan is not None:
            return self.scan(survey)
        first = self.parameters[0]
        typical = {**self.null, first.name: first.value + (first.uncertainty or 1.0)}
        return (typical,)


def grid(null: Values, **axes: Sequence[float]) -> list[dict[str, float]]:
    """Every combination of the axes' values over the null values."""
    points = [dict(null)]
    for name, values in axes.items():
        points = [{**point, name: value} for point in points for value in values]
    return points


def named(name: str) -> Cause:
    """The catalogue's cause, or one of the variants, of that name; InputError where there is none."""
    import twin.causes

    cause = load(twin.causes, name.split("/")[0], Cause)
    return next((v for v in cause.variants if v.name == name), cause)
