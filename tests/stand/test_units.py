"""Units are read, not assumed."""

import math

import pytest

from stand.errors import InputError
from stand.units import parse_quantity, parse_unit, to_si


@pytest.mark.parametrize(
    ("text", "like", "si"),
    [
        ("34 kN/m", "N/m", 34e3),
        ("27.5 N s/m", "N*s/m", 27.5),
        ("385 N*s^2/m^2", "N*s^2/m^2", 385.0),
        ("2 kg·cm²", "kg*m^2", 2e-4),
        ("1.63 g", "kg", 1.63e-3),
        ("30 deg", "rad", math.pi / 6),
        ("50 ppm", "1", 5e-5),
        (0.2, "s", 0.2),
        ("-3e-2", "m", -0.03),
    ],
)
def test_a_quantity_with_its_unit_becomes_si(text: str | float, like: str, si: float) -> None:
    assert parse_quantity(text, like) == pytest.approx(si, rel=1e-15)


def test_degrees_are_what_a_bare_angle_is_given_in() -> None:
    assert parse_quantity(30, "deg") == pytest.approx(math.pi / 6)


@pytest.mark.parametrize("unit", ["lbf", "in", "N/in", "mm Hg", "furlong", "kgf"])
def test_a_unit_that_is_not_si_is_refused_by_name(unit: str) -> None:
    with pytest.raises(InputError, match=unit.split("/")[-1].split()[-1]) as refused:
        parse_unit(unit, "run.h5:/entry/setup/fibre_stiffness")
    assert "run.h5" in str(refused.value)


def test_a_unit_of_something_else_is_refused() -> None:
    with pytest.raises(InputError, match="does not measure what 'N' does"):
        to_si(3.0, "mm", like="N", where="fibre_force")
