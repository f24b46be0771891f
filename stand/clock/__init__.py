"""The time base: raw arrivals -> a fitted clock per instrument -> one uniform 2 kHz grid."""

from stand.clock.align import align
from stand.clock.live import LiveAligner
from stand.clock.model import RATE, Aligned, Clock, GaugeStream, LiveBlock, Loss, RingStream

__all__ = ["RATE", "Aligned", "Clock", "GaugeStream", "LiveAligner", "LiveBlock", "Loss", "RingStream", "align"]
