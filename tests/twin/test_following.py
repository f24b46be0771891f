"""The experiments that a diagnosis can propose."""

from __future__ import annotations

import pytest

from stand.config import Limits
from stand.excitation.plan import plan
from stand.excitation.spec import Excitation, Shape
from twin.diagnosis.following import CANDIDATES


@pytest.mark.parametrize("candidate", CANDIDATES, ids=str)
def test_each_of_them_can_be_driven_within_the_nominal_stands_limits(
    candidate: tuple[str, float, float, float, float],
) -> None:
    shape, frequency, amplitude, ramp, _ = candidate
    motion = plan(Excitation(Shape(shape), frequency, amplitude, ramp, cycles=3), Limits())
    assert motion.peaks.acceleration <= 12.0
