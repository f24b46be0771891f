"""Columns that grow while a run lasts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]


class Columns:
    """Float64 columns of equal length that grow by doubling; views stay valid until the next `append`."""

    def __init__(self, *names: str) -> None:
        self._names, self._data, self.count = names, np.empty((len(names), 4096)), 0

    def append(self, *blocks: Float) -> None:
        """Adds one block to each column."""
        need = self.count + len(blocks[0])
        if need > self._data.shape[1]:
            grown = np.empty((len(self._names), 2 * need))
            grown[:, : self.count] = self._data[:, : self.count]
            self._data = grown
        for row, block in enumerate(blocks):
            self._data[row, self.count : need] = block
        self.count = need

    def __getitem__(self, name: str) -> Float:
        return self._data[self._names.index(name), : self.count]

    def shift(self, name: str, by: float) -> None:
        """Adds a constant to a whole column."""
        self._data[self._names.index(name), : self.count] += by
