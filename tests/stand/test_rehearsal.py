"""A run's first fit of the clocks meets no page of a library for the first time."""

from __future__ import annotations

import subprocess
import sys

import pytest

FIRST_FITS = """
import resource
import numpy as np
from stand.clock.aim import Aim
from stand.config import load_stand
from stand.runs.rehearsal import rehearse

def pages():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_minflt + usage.ru_majflt

stand = load_stand()
if {rehearsed}:
    assert rehearse(stand) > 1000, "the live grid never came out"
asked = np.arange(60) * 0.01 + np.random.default_rng(1).uniform(0, 1e-3, 60)
aim = Aim(0.01, 1e-3, 0.0, seed=1)
before = pages()
for k, at in enumerate(asked):
    aim.polled(int(at * 1000), float(at), float(at) + 5e-4 + 1e-5 * (k % 3))
print(pages() - before)
"""


def _pages_met(rehearsed: bool) -> int:
    code = FIRST_FITS.format(rehearsed=rehearsed)
    return int(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout)


@pytest.mark.skipif(sys.platform != "linux", reason="counts the pages of a Linux process")
def test_after_a_rehearsal_the_first_fit_of_a_clock_meets_nothing_new() -> None:
    assert _pages_met(rehearsed=True) < 20 < 60 < _pages_met(rehearsed=False)
