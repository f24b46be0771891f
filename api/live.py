"""From a run's blocks to messages of the live stream."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from api.decimate import Decimator
from api.hub import Hub

if TYPE_CHECKING:
    from stand.clock import LiveBlock

#: samples in one bucket on the screens: 4 ms at 2 kHz
BUCKET = 8


class Stream:
    """Publishes one experiment's samples, decimated, with the score and how late they are."""

    def __init__(self, hub: Hub, experiment: str) -> None:
        self._hub, self._experiment, self._decimator = hub, experiment, Decimator(BUCKET)

    def sampled(
        self,
        block: LiveBlock,
        simulated: Mapping[str, Any] | None,
        score: Mapping[str, Any] | None,
        latency: float,
    ) -> None:
        """One block: {"experiment", "arrival", "latency", "t", "x", "u", "F", "u_sim", "F_sim", "score"}."""
        channels = {"t": block.time, "x": block.x, "u": block.u, "F": block.F}
        if simulated is not None:
            channels |= {"u_sim": simulated["u"], "F_sim": simulated["F"]}
        message: dict[str, Any] = {"experiment": self._experiment, "arrival": block.newest_arrival}
        message |= {"latency": round(latency, 5), **(self._decimator.push(channels) or {})}
        if score is not None:
            message["score"] = score
        self._hub.publish_block(message)
