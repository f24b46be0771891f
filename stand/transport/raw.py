"""What came over a wire, untouched, with its times."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class RawBytes:
    """One read of a serial stream: its bytes and the host's time when they were there, s."""

    instrument: str
    data: bytes
    arrival: float


@dataclass(frozen=True, slots=True)
class RawRegisters:
    """One poll: registers uint16 [n], and the host's times just before the question and after the answer, s."""

    instrument: str
    registers: NDArray[np.uint16]
    request: float
    response: float


Raw = RawBytes | RawRegisters
