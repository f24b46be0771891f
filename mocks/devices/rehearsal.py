"""Everything compiled is called once before time counts: a stand that compiles while it runs falls silent meanwhile."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from time import monotonic, sleep

import numpy as np

from mocks.devices.gauge import Gauge, Trouble
from mocks.devices.world import World
from mocks.wire.line import Adapter, Line
from mocks.wire.terminal import Terminal


class _Nobody(Terminal):
    """A host that takes everything."""

    def __init__(self) -> None:
        self.port = Path()

    def connect(self) -> None:
        return

    def watched(self) -> tuple[bool, bool]:
        return True, False

    def write(self, data: bytes) -> int:
        return len(data)


def rehearse(world: World, gauges: Iterable[Gauge]) -> None:
    """The world comes to now; copies of the gauges measure and send to nobody."""
    sleep(max(0.0, world.start + 0.01 - monotonic()))
    world.advance(monotonic())
    for gauge in gauges:
        rng = np.random.default_rng(0)
        copy = replace(
            gauge, terminal=_Nobody(), rng=rng, line=Line(gauge.line.byte_time), adapter=Adapter(rng),
            log=lambda rows: _noted(rows.records()), trouble=Trouble(), tick=0, _way=[],
        )  # fmt: skip
        copy.prepare(world.now)
        copy.hand_over(world.now + 1.0)


def _noted(records: bytes) -> None:
    assert records
