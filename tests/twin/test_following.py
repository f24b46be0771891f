"""The experiments that a diagnosis can propose."""

from __future__ import annotations

import numpy as np
import pytest

from stand.config import Limits, load_stand
from stand.excitation.plan import plan
from stand.excitation.spec import Excitation, Shape
from twin.diagnosis.following import CANDIDATES
from twin.model import Start
from twin.models.force import MODEL
from twin.simulate import simulate


@pytest.mark.parametrize("candidate", CANDIDATES, ids=str)
def test_each_of_them_can_be_driven_and_leaves_the_weight_in_its_guide(
    candidate: tuple[str, float, float, float, float],
) -> None:
    shape, frequency, amplitude, ramp, mass = candidate
    motion = plan(Excitation(Shape(shape), frequency, amplitude, ramp, cycles=max(3, round(8 * frequency))), Limits())
    time = np.arange(0.0, motion.duration, 5e-4)
    setup = load_stand().setup.with_values(added_mass=mass)
    found = simulate(setup, time, motion.at(time)[0], MODEL, {}, Start())
    low, high = Limits().weight_position
    assert low / 2 < found.u.min()
    assert found.u.max() < high / 2
    assert found.F.max() < Limits().force[1] / 2
