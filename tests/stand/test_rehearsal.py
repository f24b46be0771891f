"""A run's first fits of the clocks meet no page of a library for the first time."""

from __future__ import annotations

import subprocess
import sys

FIRST_FITS = """
import resource
import numpy as np
from stand.block import Block
from stand.clock import LiveAligner
from stand.clock.aim import Aim
from stand.config import load_stand
from stand.runs.rehearsal import rehearse

def pages():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_minflt + usage.ru_majflt

stand = load_stand()
if {rehearsed}:
    assert rehearse(stand) > 3000, "the live grid never came out"
asked = np.arange(60) * 0.01 + np.random.default_rng(1).uniform(0, 1e-3, 60)
aim = Aim(0.01, 1e-3, 0.0, seed=1)
aligner = LiveAligner(stand, 7.0)
blocks = [
    Block(name, k * n, np.cos(np.arange(n) / 9.0), None, np.zeros(n, np.uint8), 7.01 + 0.01 * k, request=request)
    for k in range(240)
    for name, n, request in (("drive", 10, 7.0095 + 0.01 * k), ("dial_gauge", 20, None), ("force_gauge", 20, None))
]
before = pages()
for k, at in enumerate(asked):
    aim.polled(int(at * 1000), float(at), float(at) + 5e-4 + 1e-5 * (k % 3))
for block in blocks:
    aligner.push(block)
print(pages() - before)
"""


def _pages_met(rehearsed: bool) -> int:
    code = FIRST_FITS.format(rehearsed=rehearsed)
    return int(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout)


def test_after_a_rehearsal_the_first_fits_of_the_clocks_meet_nothing_new() -> None:
    assert 3 * _pages_met(rehearsed=True) < _pages_met(rehearsed=False)
