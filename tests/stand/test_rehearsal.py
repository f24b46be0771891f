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
{before}
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


REHEARSED = 'assert rehearse(stand) > 3000, "the live grid never came out"'
UNPLUGGED = """
from pathlib import Path
from stand.errors import DeviceError
from stand.excitation.spec import Excitation, Shape
from stand.runs.order import RunOrder
from stand.runs.rig import Rig
from stand.runs.run import perform

class Unplugged(Rig):
    def connect(self):
        raise DeviceError("no drive answers")

order = RunOrder(Excitation(Shape.RECTANGULAR, 1.0, 0.02, cycles=3.0))
with Unplugged(stand, lambda message: None) as rig:
    try:
        {what}
        raise AssertionError("a run without a drive")
    except DeviceError:
        pass
"""


def _pages_met(before: str) -> int:
    code = FIRST_FITS.format(before=before)
    return int(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout)


def test_after_a_rehearsal_the_first_fits_of_the_clocks_meet_nothing_new() -> None:
    assert 3 * _pages_met(REHEARSED) < _pages_met("")


def test_a_run_has_rehearsed_before_it_connects() -> None:
    run = UNPLUGGED.format(what='perform(rig, order, Path("never.h5"))')
    assert 2 * _pages_met(run) < _pages_met(UNPLUGGED.format(what="rig.connect()"))
