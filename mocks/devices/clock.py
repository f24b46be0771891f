"""A device's own clock: it started at some time and runs a little fast or slow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class DeviceClock:
    """Device time = (1 + drift) (true time - epoch), s; drift 1e-6 is 1 ppm fast."""

    epoch: float
    drift: float

    def device(self, true: float) -> float:
        """Device time at a true time."""
        return (1.0 + self.drift) * (true - self.epoch)

    def true(self, device: NDArray[np.float64]) -> NDArray[np.float64]:
        """True times at device times."""
        return self.epoch + device / (1.0 + self.drift)

    def moment(self, device: float) -> float:
        """The true time at a device time."""
        return self.epoch + device / (1.0 + self.drift)

    def rebased(self, true: float) -> DeviceClock:
        """The same rate, counted from another time."""
        return DeviceClock(true, self.drift)
