"""The two gauges of the default stand: GSV-8 amplifier and HL-G1 sensor."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocks.devices.gauge import Gauge
from mocks.wire import gsv8, hlg1

Float = NDArray[np.float64]


class ForceHead:
    """GSV-8 on one channel, values in N."""

    frame_bytes = gsv8.FRAME_BYTES

    def __init__(self) -> None:
        self.requests = gsv8.Requests()
        self.amplifier: gsv8.Amplifier | None = None

    def encode(self, values: Float, faulty: NDArray[np.bool_]) -> tuple[NDArray[np.uint8], Float]:
        """Frames, overload in their status; values as float32."""
        return gsv8.frames(values, faulty), gsv8.sent(values)

    def answers(self, data: bytes, gauge: Gauge) -> list[bytes]:
        """The amplifier's answers."""
        if self.amplifier is None:
            self.amplifier = gsv8.Amplifier(lambda: gauge.newest, gauge.set_zero, gauge.set_streaming, gauge.set_rate)
        return [self.amplifier.reply(*request) for request in self.requests.feed(data)]


class DialHead:
    """HL-G1 in continuous output, values in m."""

    frame_bytes = hlg1.FRAME_BYTES

    def __init__(self) -> None:
        self.requests = hlg1.Requests()
        self.sensor: hlg1.Sensor | None = None

    def encode(self, values: Float, faulty: NDArray[np.bool_]) -> tuple[NDArray[np.uint8], Float]:
        """Frames, the alarm value where there is no valid one; values as their digits say."""
        counts = hlg1.counts(values, faulty)
        return hlg1.frames(counts), np.multiply(counts, hlg1.UNIT, dtype=np.float64)

    def answers(self, data: bytes, gauge: Gauge) -> list[bytes]:
        """The sensor's answers."""
        if self.sensor is None:
            self.sensor = hlg1.Sensor(lambda: round(gauge.newest / hlg1.UNIT), gauge.set_streaming, gauge.set_rate)
        return [reply for request in self.requests.feed(data) if (reply := self.sensor.reply(request))]
