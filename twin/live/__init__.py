"""The twin beside a run: simulated from the streamed drive position, scored as it goes, stored with the run."""

from twin.live.score import ChannelScore, LiveScore
from twin.live.store import read_live, store_live
from twin.live.twin import LiveTwin

__all__ = ["ChannelScore", "LiveScore", "LiveTwin", "read_live", "store_live"]
