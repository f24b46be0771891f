"""From a run's blocks to messages of the live stream."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from api.decimate import Decimator
from api.hub import Hub

if TYPE_CHECKING:
    from stand.clock import LiveBlock
    from twin.live import ChannelScore, LiveScore

#: samples in one bucket on the screens: 4 ms at 2 kHz
BUCKET = 8


class Stream:
    """Publishes one experiment's samples, decimated, with the score and how late they are."""

    def __init__(self, hub: Hub, experiment: str) -> None:
        self._hub, self._experiment = hub, experiment
        self._measured, self._simulated = Decimator(BUCKET), Decimator(BUCKET)

    def sampled(self, block: LiveBlock, score: LiveScore | None, latency: float) -> None:
        """One block of the live stream; every channel's buckets are [lows, highs], null where nothing was sampled.

        {"experiment", "arrival" s (monotonic), "latency" s, "t" s, "x" m, "u" m, "F" N,
        "t_sim", "u_sim", "F_sim" (two samples behind), "score"}.
        """
        message: dict[str, Any] = {"experiment": self._experiment, "arrival": block.newest_arrival}
        measured = {"t": block.time, "x": block.x, "u": block.u, "F": block.F}
        message |= {"latency": round(latency, 5), **(self._measured.push(measured) or {})}
        if score is not None:
            simulated = {"t": score.time, "u": score.simulated_u, "F": score.simulated_F}
            found = self._simulated.push(simulated) or {}
            message |= {f"{name}_sim": values for name, values in found.items()} | {"score": score_view(score)}
        self._hub.publish_block(message)


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
