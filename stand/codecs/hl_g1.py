"""Panasonic HL-G1, RS-422 continuous output: %nn$sdddddddbb CR, 0.1 um a digit (HL-G1 manual, p. 100-108)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stand.codecs.codec import Bytes, Codec, Frames, starts

LENGTH = 15
RESOLUTION = 1e-7
ALARM = 9_500_000
_CR = 0x0D
_POWERS = 10 ** np.arange(6, -1, -1, dtype=np.int64)
_HEX = np.full(256, 255, np.uint8)
_HEX[np.frombuffer(b"0123456789ABCDEF", np.uint8)] = np.arange(16)


def scan(buffer: Bytes) -> Frames:
    """All frames in `buffer`, m; a frame whose check characters are neither ** nor right is junk."""
    heads = np.flatnonzero(buffer[: max(len(buffer) - LENGTH + 1, 0)] == ord("%"))
    rows = buffer[heads[:, None] + np.arange(LENGTH)]
    good = _well_formed(rows)
    begin = starts(heads[good], LENGTH)
    rows = buffer[begin[:, None] + np.arange(LENGTH)]
    digits = (rows[:, 5:12] - ord("0")).astype(np.int64) @ _POWERS
    flags = (digits >= ALARM).astype(np.uint8)
    values = np.where(rows[:, 4] == ord("-"), -digits, digits) * RESOLUTION
    ends = begin + LENGTH
    last = int(ends[-1]) if len(ends) else 0
    return Frames(ends, values, flags, _open(buffer, last))


def _well_formed(rows: NDArray[np.uint8]) -> NDArray[np.bool_]:
    digits = rows[:, 5:12]
    shape = (rows[:, 3] == ord("$")) & (rows[:, 14] == _CR) & np.all((digits >= 48) & (digits <= 57), axis=1)
    sign = (rows[:, 4] == ord("+")) | (rows[:, 4] == ord("-"))
    unchecked = (rows[:, 12] == ord("*")) & (rows[:, 13] == ord("*"))
    code = np.bitwise_xor.reduce(rows[:, :12], axis=1)
    checked = (_HEX[rows[:, 12]] == code >> 4) & (_HEX[rows[:, 13]] == code & 15)
    good: NDArray[np.bool_] = shape & sign & (unchecked | checked)
    return good


def _open(buffer: Bytes, last: int) -> int:
    """The first offset past `last` where a frame may have begun that more bytes can finish."""
    start = max(last, len(buffer) - LENGTH + 1)
    heads = np.flatnonzero(buffer[start:] == ord("%"))
    return start + int(heads[0]) if len(heads) else len(buffer)


CODEC = Codec(
    name="hl-g1",
    title="Panasonic HL-G1",
    source="HL-G1-A-C5 manual, p. 100-108",
    unit="m",
    length=LENGTH,
    scan=scan,
    flagged_is_invalid=True,
)
