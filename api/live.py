"""From a run's blocks to messages of the live stream."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from api.decimate import Decimator, Float
from api.hub import Hub

if TYPE_CHECKING:
    from stand.clock import LiveBlock
    from twin.live import ChannelScore, LiveScore

#: samples in one bucket on the screens: 4 ms at 2 kHz
BUCKET = 8


#: s of rest from which the screens take the zeros of x and u
REST = 0.4


class Stream:
    """Publishes one experiment's samples, decimated, with the score and how late they are."""

    def __init__(self, hub: Hub, experiment: str) -> None:
        self._hub, self._experiment = hub, experiment
        self._measured, self._simulated, self._zero = Decimator(BUCKET), Decimator(BUCKET), Zero()

    def sampled(self, block: LiveBlock, score: LiveScore | None, latency: float) -> None:
        """One block of the live stream; every channel's buckets are [lows, highs], null where nothing was sampled.

        {"experiment", "arrival" s (monotonic), "latency" s, "t" s, "x" m, "u" m, "F" N,
        "t_sim", "u_sim", "F_sim" (two samples behind), "score"}.
        """
        message: dict[str, Any] = {"experiment": self._experiment, "arrival": block.newest_arrival}
        x0, u0 = self._zero.of(block)
        measured = {"t": block.time, "x": block.x - x0, "u": block.u - u0, "F": block.F}
        message |= {"latency": round(latency, 5), **(self._measured.push(measured) or {})}
        if score is not None:
            simulated = {"t": score.time, "u": score.simulated_u, "F": score.simulated_F}
            found = self._simulated.push(simulated) or {}
            message |= {f"{name}_sim": values for name, values in found.items()} | {"score": score_view(score)}
        self._hub.publish_block(message)


class Zero:
    """x and u at rest: medians over the first 0.4 s, as the twin takes them; what came before shifts with them."""

    def __init__(self) -> None:
        self._x: list[Float] = []
        self._u: list[Float] = []
        self._known: tuple[float, float] | None = None

    def of(self, block: LiveBlock) -> tuple[float, float]:
        """The zeros as far as they are known with this block, m."""
        if self._known is not None:
            return self._known
        self._x.append(block.x)
        self._u.append(block.u)
        zeros = (float(np.nanmedian(np.concatenate(self._x))), float(np.nanmedian(np.concatenate(self._u))))
        if float(block.time[-1]) >= REST:
            self._known = zeros
        return zeros


def score_view(score: LiveScore) -> dict[str, Any]:
    """The scores as JSON: per channel R, sliding_R, nrmse, lag_s; short-window errors (m, N); null for undefined."""
    return {
        "u": _channel(score.u),
        "F": _channel(score.F),
        "short": {"u": _number(score.u.short_error), "F": _number(score.F.short_error)},
        "latest": {"u": _number(score.u.latest_short_error), "F": _number(score.F.latest_short_error)},
        "dropped": score.dropped,
        "load": round(score.load, 4),
        "notes": list(score.notes),
    }


def _channel(score: ChannelScore) -> dict[str, float | None]:
    values = {"R": score.R, "sliding_R": score.window_R, "nrmse": score.nrmse, "lag_s": score.lag}
    return {name: _number(value) for name, value in values.items()}


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None
