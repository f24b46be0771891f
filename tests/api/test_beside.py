"""A situation of the papers on the nominal stand, beside what S1 prints."""

from __future__ import annotations

import math

import pytest

from api.beside import judged, reasons, table_rows
from api.catalogue import describe_situations
from api.orders import Order
from api.simulations import ordered


@pytest.mark.slow
def test_a_slow_situation_gives_one_r_for_both_dampings_and_says_why_s1_has_two() -> None:
    published = next(s["published_R"] for s in describe_situations() if s["name"] == "11")
    found = judged(ordered(Order(situation="11")), ["force", "force-damping"], lambda what, share: None)
    (_, one, two, here, there), (_, _, _, force, _) = table_rows(published, found)
    assert (one, two) == (0.2187, 0.6890)
    assert here == there > 0.999
    assert 0.9 < force < 1.0
    assert any("contradict" in reason for reason in reasons(found))
    assert math.isfinite(found.ceiling_u)
    assert all(run.score_u.peak_error > 0.0 for run in found.runs)
