"""A motion is jerk-limited, starts and ends at rest, and one the stand can't take is refused with what it can."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from stand.config import load_stand
from stand.errors import InputError
from stand.excitation.plan import plan, waveforms
from stand.excitation.situations import situations
from stand.excitation.spec import Excitation, Shape

LIMITS = load_stand().limits
ORDERS = [
    Excitation(Shape.TRAPEZOIDAL, 1.25, 0.03, 0.2, 3),
    Excitation(Shape.RECTANGULAR, 1.0, 0.09, 0.0, 2),
    Excitation(Shape.RECTANGULAR, 2.0, 0.002, 0.0, 2),
    Excitation(Shape.QUASI_SINUSOIDAL, 0.35, 0.09, 0.0, 2),
]


@pytest.mark.parametrize("order", ORDERS, ids=lambda o: f"{o.shape}-{o.amplitude}")
def test_a_motion_swings_the_stroke_within_every_limit_and_is_smooth(order: Excitation) -> None:
    motion = plan(order, LIMITS)
    t = np.arange(0, motion.duration, 1e-4)
    x, v, a, j = motion.at(t)
    settled = t > motion.rest + 0.9 / order.frequency
    assert np.ptp(x[settled & (t < motion.duration - motion.rest - 0.5 / order.frequency)]) == pytest.approx(
        order.amplitude, rel=2e-3
    )
    assert np.abs(v).max() <= LIMITS.speed
    assert np.abs(a).max() <= LIMITS.acceleration
    assert np.abs(j).max() <= LIMITS.jerk
    np.testing.assert_allclose(np.gradient(x, t)[1:-1], v[1:-1], atol=1e-4)
    np.testing.assert_allclose(np.gradient(v, t)[1:-1], a[1:-1], atol=0.05)
    assert (motion.peaks.speed, motion.peaks.acceleration) == pytest.approx(
        (np.abs(v).max(), np.abs(a).max()), rel=0.01
    )


@pytest.mark.parametrize("order", ORDERS, ids=lambda o: f"{o.shape}-{o.amplitude}")
def test_a_run_rests_a_second_before_and_after(order: Excitation) -> None:
    motion = plan(order, LIMITS)
    for t in (np.linspace(0, 1, 50), motion.duration - np.linspace(0, 0.999, 50)):
        x, v, a, _ = motion.at(t)
        assert np.ptp(x) < 1e-12
        assert not v.any()
        assert not a.any()
    assert motion.span[0] <= 0 <= motion.span[1]


@pytest.mark.parametrize(
    "order",
    [
        Excitation(Shape.TRAPEZOIDAL, 3, 0.05, 0.05, 8),
        Excitation(Shape.TRAPEZOIDAL, 4, 0.09, 0.1, 8),
        Excitation(Shape.QUASI_SINUSOIDAL, 5, 0.03, 0, 8),
        Excitation(Shape.RECTANGULAR, 5, 0.09, 0, 8),
    ],
    ids=lambda o: str(o.shape),
)
def test_too_fast_a_motion_is_refused_with_the_largest_that_would_do(order: Excitation) -> None:
    with pytest.raises(InputError) as refused:
        plan(order, LIMITS)
    remedy = str(refused.value.remedy)
    ramp = re.search(r"ramp of (?:at least )?([\d.]+) s", remedy)
    hertz = re.search(r"[Aa]t most ([\d.]+) Hz", remedy)
    assert ramp or hertz
    mended = replace(
        order,
        ramp=float(ramp[1]) if ramp else order.ramp,
        frequency=float(hertz[1]) * 0.999 if hertz else order.frequency,
    )
    plan(mended, LIMITS)


def test_the_remedy_is_the_limit_and_not_merely_something_safe() -> None:
    with pytest.raises(InputError, match=r"at most 3\.22 Hz at this stroke"):
        plan(Excitation(Shape.QUASI_SINUSOIDAL, 5, 0.03, 0, 8), LIMITS)
    with pytest.raises(InputError):
        plan(Excitation(Shape.QUASI_SINUSOIDAL, 3.24, 0.03, 0, 8), LIMITS)


@pytest.mark.parametrize(
    ("order", "complaint"),
    [
        (Excitation(Shape.TRAPEZOIDAL, 1, 0.12, 0.2, 2), "longer than the travel.*At most 96 mm"),
        (Excitation(Shape.TRAPEZOIDAL, 1, 0.02, 0.2, 1.5), "whole number of cycles.*2 cycles"),
        (Excitation(Shape.TRAPEZOIDAL, 0, 0.02, 0.2, 2), "frequency.*positive"),
        (Excitation(Shape.TRAPEZOIDAL, 1, float("nan"), 0.2, 2), "amplitude.*positive"),
        (Excitation(Shape.RELEASE, 1, 0.01, 0, 1, 0.02), "not a motion of the drive"),
    ],
)
def test_an_order_that_makes_no_sense_is_refused(order: Excitation, complaint: str) -> None:
    with pytest.raises(InputError, match=complaint):
        plan(order, LIMITS)


def test_a_stroke_that_does_not_fit_from_the_rest_is_centred_on_the_travel() -> None:
    assert plan(ORDERS[0], LIMITS, 0.030).rest_travel == 0.030
    assert plan(ORDERS[3], LIMITS, 0.030).rest_travel == pytest.approx(0.005)


def test_the_papers_situations_are_found_and_can_be_run() -> None:
    found = situations()
    assert list(found) == ["2", "3c", "7a", "10", "11"]
    assert found["7a"].added_mass == 5.035
    assert found["3c"].published["weight_position"] == (0.7552, 0.9190)
    for situation in found.values():
        assert plan(situation.excitation, LIMITS).duration == pytest.approx(10.0, abs=1.0)


def test_each_waveform_in_the_folder_is_one_shape() -> None:
    assert set(waveforms()) == {Shape.TRAPEZOIDAL, Shape.RECTANGULAR, Shape.QUASI_SINUSOIDAL}
