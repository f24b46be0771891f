"""An order in the words of form and command line becomes an excitation and a setup, or says what is wrong with it."""

from __future__ import annotations

from typing import Any

import pytest

from api.orders import Order, checked, validate
from stand.config import load_stand
from stand.errors import InputError
from stand.excitation.spec import Excitation, Shape

STAND = load_stand()
WHOLE = {"shape": "trapezoidal", "frequency": 1.25, "amplitude": 0.03, "ramp": 0.2, "cycles": 12}


def order(**fields: Any) -> Order:
    return checked(Order, fields)


def test_a_whole_order_is_taken_as_it_is() -> None:
    assert order(**WHOLE).excitation() == Excitation(Shape.TRAPEZOIDAL, 1.25, 0.03, 0.2, 12)


def test_a_situation_fills_in_what_is_left_out_and_yields_to_what_is_stated() -> None:
    found = order(situation="7a", amplitude=0.02).excitation()
    assert (found.frequency, found.ramp, found.amplitude) == (1.25, 0.2, 0.02)
    assert order(situation="7a").setup(STAND).added_mass == 5.035
    assert order(situation="7a", added_mass=False).setup(STAND).added_mass == 0.0


def test_a_duration_stands_for_the_whole_cycles_that_fit_in() -> None:
    assert order(**{**WHOLE, "cycles": None}, duration=10.0).excitation().cycles == 12
    assert order(shape="quasi-sinusoidal", frequency=2, amplitude=0.01, duration=10.0).excitation().cycles == 20


@pytest.mark.parametrize(
    ("fields", "named"),
    [
        ({**WHOLE, "shape": None}, "shape"),
        ({**WHOLE, "ramp": None}, "ramp"),
        ({**WHOLE, "frequency": -1.0}, "frequency"),
        ({**WHOLE, "cycles": 2.5}, "cycles"),
        ({**WHOLE, "cycles": None}, "cycles"),
        ({**WHOLE, "cycles": None, "duration": 0.1}, "duration"),
        ({**WHOLE, "situation": "99"}, "situation"),
        ({**WHOLE, "added_mass": -1.0}, "added_mass"),
        ({**WHOLE, "amplitude": 0.3}, "amplitude"),
    ],
)
def test_what_can_not_be_run_is_named_with_its_field(fields: dict[str, Any], named: str) -> None:
    found = validate(order(**fields), STAND)
    assert not found.valid
    assert [error.field for error in found.errors] == [named]


def test_beyond_the_stands_limits_the_admissible_values_are_told() -> None:
    found = validate(order(**{**WHOLE, "amplitude": 0.09, "ramp": 0.05}), STAND)
    assert not found.valid
    assert "at most 1.5 mm" in found.errors[0].message


def test_a_good_order_shows_its_peaks_beside_the_limits_and_a_picture() -> None:
    plan = validate(order(**WHOLE), STAND).plan
    assert plan is not None
    assert plan.seconds == pytest.approx(12 / 1.25 + 2.0, abs=0.01)
    assert all(0 < limit.value < limit.limit for limit in plan.limits)
    assert max(plan.preview.x) - min(plan.preview.x) == pytest.approx(0.03, rel=1e-3)


def test_a_misspelt_field_of_the_command_line_is_told_by_its_option() -> None:
    with pytest.raises(InputError, match="--added-mass"):
        order(**WHOLE, added_mass="heavy")
