"""An order turned into a motion whose whole envelope is checked before anything moves."""

from __future__ import annotations

import importlib
import math
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

import stand.excitation.waveforms
from stand.config import Limits
from stand.errors import InputError
from stand.excitation.curve import Curve, Float, Peaks, Waveform
from stand.excitation.spec import Excitation, Shape

REST = 1.0
MARGIN = 0.002
_TABLE = 1e-3


@dataclass(frozen=True)
class Plan:
    """A checked motion: `rest` s at rest, the curve, `rest` s at rest. rest_travel: where on the drive's travel, m."""

    excitation: Excitation
    curve: Curve
    rest_travel: float
    rest: float = REST

    @property
    def duration(self) -> float:
        """Seconds, both rests included."""
        return self.curve.duration + 2 * self.rest

    @property
    def peaks(self) -> Peaks:
        """Largest speed, acceleration and jerk."""
        return self.curve.peaks

    @property
    def span(self) -> tuple[float, float]:
        """Lowest and highest x, m."""
        return self.curve.span

    def at(self, t: Float) -> Float:
        """x m, x', x'', x''' [4, n] at t s since the beginning of the first rest."""
        since = np.asarray(t, dtype=np.float64) - self.rest
        out = self.curve.evaluate(np.clip(since, 0.0, self.curve.duration))
        out[1:, (since < 0) | (since > self.curve.duration)] = 0.0
        return out

    @cached_property
    def _table(self) -> tuple[list[float], list[float]]:
        """x and x' every millisecond, for a loop that asks often."""
        x, v = self.at(np.arange(0.0, self.duration + 0.2, _TABLE))[:2]
        return x.tolist(), v.tolist()

    def state(self, t: float) -> tuple[float, float]:
        """x m and x' m/s at one time, from a table of 1 ms (within 2 um, 0.1 mm/s)."""
        x, v = self._table
        place = min(max(t / _TABLE, 0.0), len(x) - 2.0)
        k = int(place)
        share = place - k
        return x[k] + share * (x[k + 1] - x[k]), v[k] + share * (v[k + 1] - v[k])


def waveforms() -> dict[Shape, Waveform]:
    """The shapes found in the folder."""
    found: dict[Shape, Waveform] = {}
    for module in pkgutil.iter_modules(stand.excitation.waveforms.__path__):
        loaded = importlib.import_module(f"{stand.excitation.waveforms.__name__}.{module.name}")
        found |= {w.shape: w for w in vars(loaded).values() if isinstance(w, Waveform)}
    return found


def plan(excitation: Excitation, limits: Limits, rest_travel: float = 0.030) -> Plan:
    """The motion, or InputError naming the limit it passes and the largest value that would not.

    rest_travel: where the drive should rest, m; where the stroke doesn't fit from there, the middle is taken.
    """
    _check_numbers(excitation)
    waveform = waveforms().get(excitation.shape)
    if waveform is None:
        known = ", ".join(waveforms())
        raise InputError(
            "not a motion of the drive", where="shape", value=str(excitation.shape), remedy=f"One of {known}"
        )
    travel = _rest(excitation.amplitude, limits, rest_travel)
    if waveform.shape is Shape.TRAPEZOIDAL and not excitation.ramp:
        excitation = replace(excitation, ramp=0.25 / excitation.frequency)
    curve = waveform.build(excitation, limits)
    passed = _passed(curve.peaks, limits)
    if passed:
        raise _too_fast(excitation, waveform, limits, *passed)
    return Plan(excitation, curve, travel)


def _check_numbers(excitation: Excitation) -> None:
    for name, unit in (("frequency", "Hz"), ("amplitude", "m"), ("cycles", "")):
        value = getattr(excitation, name)
        if not (math.isfinite(value) and value > 0):
            raise InputError(
                "must be positive", where=name, value=value, remedy=f"State it, in {unit}" if unit else "State it"
            )
    if abs(excitation.cycles - round(excitation.cycles)) > 1e-9:
        remedy = f"Take {math.ceil(excitation.cycles)} cycles"
        raise InputError("not a whole number of cycles", where="cycles", value=excitation.cycles, remedy=remedy)
    if not (math.isfinite(excitation.ramp) and excitation.ramp >= 0):
        raise InputError("must not be negative", where="ramp", value=excitation.ramp, remedy="Give it in s")


def _rest(amplitude: float, limits: Limits, preferred: float) -> float:
    low, high = (float(end) for end in limits.travel)
    room = high - low - 2 * MARGIN
    if amplitude > room:
        remedy = f"At most {room * 1e3:.4g} mm"
        raise InputError("the stroke is longer than the travel", where="amplitude", value=amplitude, remedy=remedy)
    if low + MARGIN <= preferred and preferred + amplitude <= high - MARGIN:
        return preferred
    return (low + high - amplitude) / 2


def _passed(peaks: Peaks, limits: Limits) -> tuple[str, float, float, str] | None:
    """The first limit that is passed: name, value, limit, unit."""
    for name, unit in (("speed", "m/s"), ("acceleration", "m/s^2"), ("jerk", "m/s^3")):
        value, limit = getattr(peaks, name), getattr(limits, name)
        if value > limit * (1 + 1e-9):
            return name, value, limit, unit
    return None


def _too_fast(
    excitation: Excitation, waveform: Waveform, limits: Limits, name: str, value: float, limit: float, unit: str
) -> InputError:
    stroke = f"{excitation.amplitude * 1e3:.4g} mm"

    def fits(changed: Excitation) -> bool:
        try:
            return _passed(waveform.build(changed, limits).peaks, limits) is None
        except InputError:
            return False

    amplitude = _largest(lambda f: fits(replace(excitation, amplitude=f * excitation.amplitude)))
    ways = [f"at most {_down(amplitude * excitation.amplitude * 1e3)} mm at {excitation.frequency:g} Hz"]
    if excitation.shape is Shape.TRAPEZOIDAL:
        share = _largest(lambda f: fits(replace(excitation, ramp=excitation.ramp / f, frequency=1e-3)))
        ramp = float(_up(excitation.ramp / share))
        if ramp <= 0.5 / excitation.frequency:
            ways.insert(0, f"a ramp of at least {ramp:g} s at this stroke")
        else:
            ways.insert(0, f"at most {_down(0.5 / ramp)} Hz at this stroke, with a ramp of {ramp:g} s")
    else:
        frequency = _largest(lambda f: fits(replace(excitation, frequency=f * excitation.frequency)))
        ways.insert(0, f"at most {_down(frequency * excitation.frequency)} Hz at this stroke")
    remedy = "Take " + ", or ".join(ways)
    what = f"{name} of {value:.4g} {unit} passes the limit of {limit:g} {unit} (stroke {stroke})"
    return InputError(
        what, where=f"excitation: {excitation.shape}", value=f"{excitation.frequency:g} Hz", remedy=remedy
    )


def _largest(fits: Callable[[float], bool]) -> float:
    """The largest factor in (0, 1] that fits, by bisection."""
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def _down(value: float) -> str:
    """Three digits, rounded so that the value still fits."""
    digits = 2 - math.floor(math.log10(value))
    return f"{math.floor(value * 10**digits) / 10**digits:g}"


def _up(value: float) -> str:
    digits = 2 - math.floor(math.log10(value))
    return f"{math.ceil(value * 10**digits) / 10**digits:g}"
