"""Samples for the screen: each bucket keeps its extremes, so that no snatch is lost between two pixels."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Buckets = list[float | None] | list[list[float | None]]


class Decimator:
    """Turns a stream of samples into buckets of `width` samples; what does not fill a bucket waits."""

    def __init__(self, width: int) -> None:
        self._width = width
        self._rest: dict[str, Float] = {}

    def push(self, channels: Mapping[str, Float]) -> dict[str, Buckets] | None:
        """Buckets of what came: "t" [k] mid times, else name -> [[lows], [highs]]; None while no bucket is full.

        channels: "t" and others, [n] each. Values that are no number make a bucket's extremes null-like (nan is
        left out; a bucket of nothing but nan gives nan, which `clean` turns into None).
        """
        joined = {name: np.concatenate([self._rest.get(name, _EMPTY), values]) for name, values in channels.items()}
        count = len(joined["t"]) // self._width
        self._rest = {name: values[count * self._width :] for name, values in joined.items()}
        if not count:
            return None
        return {name: _bucket(name, values, count, self._width) for name, values in joined.items()}


_EMPTY: Float = np.empty(0)


def _bucket(name: str, values: Float, count: int, width: int) -> Buckets:
    table = values[: count * width].reshape(count, width)
    if name == "t":
        return clean(table.mean(axis=1), 5)
    return [clean(table.min(axis=1), _DIGITS.get(name[0], 6)), clean(table.max(axis=1), _DIGITS.get(name[0], 6))]


#: decimals that a screen can show: positions to 1 um, forces to 1 mN
_DIGITS = {"x": 6, "u": 6, "F": 3}


def clean(values: Float, digits: int) -> list[float | None]:
    """A list of rounded numbers; what is not finite becomes None."""
    return [value if value - value == 0.0 else None for value in np.round(values, digits).tolist()]
