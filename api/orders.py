"""What an operator orders: an experiment in the words of the form and the command line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from api.problem import FieldError
from stand.errors import InputError
from stand.excitation.spec import Excitation, Shape

if TYPE_CHECKING:
    from stand.config import Stand
    from stand.excitation.plan import Plan
    from stand.excitation.situations import Situation
    from stand.setup import Setup

#: S0, S1: the mass that is added in some situations, kg
ADDED_MASS = 5.035
PREVIEW_POINTS = 160


class Order(BaseModel):
    """An experiment. What a named situation states may be left out; `duration` (s of motion) stands for `cycles`."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={
            "examples": [
                {"situation": "2"},
                {"shape": "trapezoidal", "frequency": 1.25, "amplitude": 0.03, "ramp": 0.2, "cycles": 12},
                {"shape": "quasi-sinusoidal", "frequency": 0.35, "amplitude": 0.09, "duration": 10, "added_mass": True},
            ]
        },
    )

    situation: str | None = Field(default=None, description="a preset of GET /situations; other fields override it")
    shape: Shape | None = None
    frequency: float | None = Field(default=None, description="Hz")
    amplitude: float | None = Field(default=None, description="peak-to-peak stroke, m")
    ramp: float | None = Field(default=None, description="s from one level to the other, trapezoid only")
    cycles: float | None = Field(default=None, description="whole cycles")
    duration: float | None = Field(default=None, description="s of motion, where cycles are not given")
    added_mass: bool | float | None = Field(
        default=None, description="whether the added mass (5.035 kg) is mounted, or how much is, kg"
    )
    comment: Annotated[str, Field(max_length=200)] = ""
    model: str = Field(
        default="force",
        description="the model that runs beside: of GET /models, or a run whose diagnosis extended one",
    )

    def excitation(self) -> Excitation:
        """The excitation; InputError naming the field that is missing or impossible."""
        base = self._situation()
        shape = self.shape or (base.excitation.shape if base else None)
        if shape is None:
            raise InputError("missing", where="shape", remedy=f"One of {', '.join(Shape)}, or name a situation")
        frequency = self._positive("frequency", base)
        ramp = self._positive("ramp", base) if shape is Shape.TRAPEZOIDAL else 0.0
        cycles = self._cycles(frequency, base)
        return Excitation(shape, frequency, self._positive("amplitude", base), ramp, cycles)

    def setup(self, stand: Stand) -> Setup:
        """The stand's setup with or without the added mass, as ordered."""
        mass = self.mass()
        return stand.setup if mass is None else stand.setup.with_values(added_mass=mass)

    def mass(self) -> float | None:
        """The added mass, kg; None where the order leaves it as the stand's setup has it."""
        base = self._situation()
        if self.added_mass is None:
            return base.added_mass if base else None
        if isinstance(self.added_mass, bool):
            return ADDED_MASS if self.added_mass else 0.0
        if not 0.0 <= self.added_mass < float("inf"):
            raise InputError("must be 0 or more", where="added_mass", value=self.added_mass, remedy="Give it in kg")
        return self.added_mass

    def _situation(self) -> Situation | None:
        if self.situation is None:
            return None
        return situation(self.situation)

    def _positive(self, name: str, base: Situation | None) -> float:
        value = getattr(self, name)
        if value is None and base is not None:
            value = getattr(base.excitation, name) or None
        if value is None:
            raise InputError("missing", where=name, remedy="State it, or name a situation")
        if not value > 0 or value == float("inf"):
            unit = {"frequency": "Hz", "amplitude": "m", "ramp": "s"}[name]
            raise InputError("must be positive", where=name, value=value, remedy=f"Give it in {unit}, above 0")
        return float(value)

    def _cycles(self, frequency: float, base: Situation | None) -> float:
        cycles = self.cycles
        if cycles is None and self.duration is not None:
            cycles = int(self.duration * frequency + 1e-9)
            if cycles < 1:
                remedy = f"At least {1 / frequency:.3g} s for one cycle"
                raise InputError("shorter than one cycle", where="duration", value=self.duration, remedy=remedy)
        if cycles is None and base is not None:
            cycles = base.excitation.cycles or None
        if cycles is None:
            raise InputError("missing", where="cycles", remedy="State cycles or a duration")
        if cycles < 1 or cycles != int(cycles):
            remedy = "State whole cycles"
            raise InputError("must be a whole number, 1 or more", where="cycles", value=cycles, remedy=remedy)
        return float(cycles)


def situation(name: str) -> Situation:
    """The preset of that name; InputError listing the known ones."""
    from stand.excitation.situations import situations

    known = situations()
    if name not in known:
        remedy = f"Known: {', '.join(known)}"
        raise InputError("no situation of that name", where="situation", value=name, remedy=remedy)
    return known[name]


class Limit(BaseModel):
    """A peak of the plan beside the stand's limit, SI; shown times `scale` in `unit`."""

    name: str
    value: float
    limit: float
    unit: str
    scale: float = 1.0


class Preview(BaseModel):
    """The first two cycles: s, m."""

    t: list[float]
    x: list[float]


class PlanView(BaseModel):
    """What would be done: whole length in s with the rests, peaks beside limits, a picture of the motion."""

    seconds: float
    cycles: float
    limits: list[Limit]
    preview: Preview


class Validation(BaseModel):
    """Whether the order can be run as it is, and if not, why."""

    valid: bool
    errors: list[FieldError] = []
    plan: PlanView | None = None


def validate(order: Order, stand: Stand) -> Validation:
    """Check an order against the stand without moving anything."""
    try:
        order.setup(stand)
        excitation = order.excitation()
        plan = make_plan(excitation, stand)
    except InputError as error:
        field = error.where.rpartition(".")[2].rpartition("/")[2]
        text = str(error).removeprefix(f"{error.where}: ")
        known = field if field in Order.model_fields else ""
        return Validation(valid=False, errors=[FieldError(field=known, message=text)])
    return Validation(valid=True, plan=_view(plan, excitation, stand))


def make_plan(excitation: Excitation, stand: Stand) -> Plan:
    """The checked plan of an excitation on this stand; InputError with the largest admissible value."""
    from stand.excitation.plan import plan

    return plan(excitation, stand.limits, rest_travel=stand.drive.rest_travel)


def _view(plan: Plan, excitation: Excitation, stand: Stand) -> PlanView:
    t = np.linspace(0.8, min(1.2 + 2.0 / excitation.frequency, plan.duration), PREVIEW_POINTS)
    x = np.asarray(plan.at(t)[0])
    rows = [
        Limit(name="speed", value=plan.peaks.speed, limit=stand.limits.speed, unit="m/s"),
        Limit(name="acceleration", value=plan.peaks.acceleration, limit=stand.limits.acceleration, unit="m/s²"),
        Limit(name="jerk", value=plan.peaks.jerk, limit=stand.limits.jerk, unit="m/s³"),
    ]
    preview = Preview(t=t.round(4).tolist(), x=x.round(6).tolist())
    return PlanView(seconds=float(plan.duration), cycles=excitation.cycles, limits=rows, preview=preview)


def checked(kind: type[Order], fields: dict[str, Any]) -> Order:
    """An order from words of a command line; InputError naming the field that has no such value."""
    try:
        return kind.model_validate({name: value for name, value in fields.items() if value is not None})
    except ValidationError as error:
        first = error.errors()[0]
        where = "--" + ".".join(str(part) for part in first["loc"]).replace("_", "-")
        raise InputError(first["msg"], where=where, value=first.get("input")) from error
