"""The simulated drive's own path: ramps that end at rest, new targets without a jump."""

import numpy as np
import pytest

from mocks.devices.trajectory import Ramps, Trajectory, move_pieces


@pytest.mark.parametrize("start", [(0.0, 0.0), (0.0, 0.3), (0.0, -0.3), (0.09, 0.6), (0.0, 0.9)])
def test_a_trapezoid_ends_at_rest_on_its_target_from_any_state(start: tuple[float, float]) -> None:
    ramps = Ramps(0.5, 4.0, 6.0)
    pieces = move_pieces(start, 0.1, ramps)
    (x, v), peak = start, 0.0
    for span, a in pieces:
        assert span >= 0.0
        x, v = x + span * (v + 0.5 * a * span), v + a * span
        peak = max(peak, abs(v))
    assert (x, v) == (pytest.approx(0.1), pytest.approx(0.0, abs=1e-12))
    assert peak <= max(0.5, abs(start[1])) + 1e-12


def test_a_new_target_on_the_way_leaves_no_jump() -> None:
    path = Trajectory(0.0, 0.0)
    path.move(0.0, 0.1, Ramps(0.5, 4.0, 4.0))
    path.move(0.1, -0.1, Ramps(0.5, 4.0, 4.0))
    before, after = path.sample(np.array([0.1, 0.1 + 1e-9]))[:, :2]
    assert after == pytest.approx(before, abs=1e-7)
