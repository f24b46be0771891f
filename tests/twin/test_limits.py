"""Limits that are read off the records: a gauge's highest level and a stop in the guide, and neither on plain hops."""

import numpy as np
import pytest

from stand.recording import Recording
from stand.setup import Setup
from twin.diagnosis import clipped
from twin.diagnosis.run import Run, prepare

GAUGES = ("dial-gauge-saturation", "force-gauge-saturation")
DT, FALL, SPEED = 5e-4, 6.0, 0.9  # s, m/s^2 down the incline, m/s at which a hop begins


def hops(stop: float = np.inf, level: float = np.inf, base: float = 0.0) -> Run:
    """A weight thrown up again and again from `base`, braked at `stop`, its gauge at an end at `level`; 6 um noise."""
    rng = np.random.default_rng(3)
    u, place, speed = np.zeros(12000), base, 0.0
    for i in range(1600, len(u)):
        place, speed = place + speed * DT, speed - FALL * DT
        if place <= base:
            place, speed = base, SPEED
        if place > stop and speed > 0.0:
            speed = -0.4 * speed
        u[i] = place
    told = np.minimum(u, level) + rng.normal(0.0, 6e-6, len(u))
    force = np.where(u <= base, 15.0, 0.0) + rng.normal(0.0, 0.12, len(u))
    channels = {"drive_position": rng.normal(0.0, 2e-6, len(u)), "weight_position": told, "fibre_force": force}
    return prepare(Recording(None, Setup(), np.arange(len(u)) * DT, channels))


def test_a_gauge_at_its_end_is_seen_with_its_level_and_what_lies_there_is_not_used() -> None:
    runs, limits = clipped.find([hops(level=0.05)], GAUGES)
    assert [limit.cause for limit in limits] == ["dial-gauge-saturation"]
    assert limits[0].level == pytest.approx(0.05, abs=1e-6)
    assert runs[0].bad[runs[0].raw_u > 0.04999, 0].mean() > 0.99
    assert not runs[0].bad[:, 1].any()


def test_a_stop_is_met_where_the_weight_is_braked() -> None:
    met = clipped.stop([hops(stop=0.05)])
    assert [limit.cause for limit in met] == ["end-stop"]
    assert met[0].level == pytest.approx(0.05, abs=2e-3)


def test_plain_hops_have_neither() -> None:
    assert clipped.find([hops()], GAUGES)[1] == []
    assert clipped.stop([hops()]) == []


def test_the_end_of_the_guide_is_where_it_should_be() -> None:
    assert clipped.stop([hops(stop=0.25, base=0.2)]) == []
