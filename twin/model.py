"""A fibre model: data and four functions that carry a state from sample to sample."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from stand.setup import Setup, System
from twin.parameter import Parameter, Source

Float = NDArray[np.float64]


class Status(IntEnum):
    """How a kernel ended; the members are sentences (see `sentence`)."""

    THE_MODEL_REACHED_THE_LAST_SAMPLE = 0
    A_STEP_DID_NOT_CONVERGE = 1
    THE_STATE_LEFT_THE_RANGE_OF_NUMBERS = 2
    TOO_MANY_SLACK_SWITCHES_IN_ONE_SAMPLE = 3

    @property
    def sentence(self) -> str:
        """The member's name as a sentence."""
        return self.name.replace("_", " ").lower()


@dataclass(frozen=True)
class Start:
    """A measured instant from which a model is (re)started: u, x in m, v, w in m/s, tension at the gauge in N.

    s and rim_speed (m, m/s) say where the pulley is, where that is known; otherwise the model balances it.
    """

    u: float = 0.0
    v: float = 0.0
    x: float = 0.0
    w: float = 0.0
    force: float | None = None
    s: float | None = None
    rim_speed: float | None = None


@dataclass(frozen=True)
class FibreModel:
    """One way to describe the fibre between drive and weight (a plug-in: one instance in one file).

    constants(setup, parameters): float64 [k], all that the kernel needs, packed. `parameters` holds the
        model's own parameters by name (those left out take their nominal values).
    start(constants, start): the state, float64 [s], at a measured instant; state[0] = u, state[1] = u'.
    advance(constants, state, drive, dt, out): carries `state` (changed in place) over len(drive) - 1
        intervals of dt seconds. drive: float64 [n + 1, 2], x and x' at the samples, cubic Hermite between;
        for a rig without a drive zeros. out: float64 [n, 3], u, u', F at samples 1..n. Returns a Status.
        Two calls over a split drive give what one call over the whole gives, bit for bit.
    warm(): compiles or loads the kernel, so that a caller can show progress.
    """

    name: str
    title: str
    source: Source
    systems: frozenset[System]
    parameters: tuple[Parameter, ...]
    state: tuple[str, ...]
    constants: Callable[[Setup, Mapping[str, float]], Float]
    start: Callable[[Float, Start], Float]
    advance: Callable[[Float, Float, Float, float, Float], int]
    warm: Callable[[], None]
