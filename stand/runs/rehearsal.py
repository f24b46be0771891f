"""What a run computes while it reads is computed once before: a page of a numerical library that is met for the first
time comes from the disk, with the interpreter's lock held.

Measured: the first fit of the ring's clock held up every reader by 15 to 240 ms on a machine that had read other files
meanwhile; the drive's ring keeps 60 ms.
"""

from __future__ import annotations

import numpy as np

from stand.block import Block
from stand.clock import LiveAligner
from stand.clock.aim import FIRST, Aim
from stand.clock.live import nominal_rate
from stand.config import Stand

#: s of made-up samples, long enough for the gauges' rates to be fitted, and of each read
LENGTH, READ = 2.5, 0.01


def rehearse(stand: Stand) -> int:
    """Align made-up streams of the stand's instruments live, aim at a made-up ring; the grid samples that came out."""
    aligner, told = LiveAligner(stand, 0.0), 0
    rates = {name: nominal_rate(config) for name, config in stand.instruments.items()}
    tick = 1.0 / rates["drive"]
    aim = Aim(1.0 / stand.drive.poll_rate, tick, 0.0, seed=0)
    for poll in range(FIRST):
        asked = poll * aim.period
        aim.polled(int(asked / tick + 0.5), asked, asked + 5e-4 + 1e-5 * (poll % 7))
    aim.next(LENGTH)
    for read in range(round(LENGTH / READ)):
        for name, rate in rates.items():
            told += _push(aligner, name, read * READ, rate)
    return told


def _push(aligner: LiveAligner, name: str, begin: float, rate: float) -> int:
    first, last = round(begin * rate), round((begin + READ) * rate)
    values = np.sin(np.arange(first, last))
    arrival = begin + READ + 1e-5 * (first % 7)
    request = arrival - 5e-4 if name == "drive" else None
    block = aligner.push(Block(name, first, values, None, np.zeros(len(values), np.uint8), arrival, request=request))
    return 0 if block is None else len(block.time)
