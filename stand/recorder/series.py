"""A dataset that grows: appended in blocks, uncompressed, without touching the file's structure.

One chunk holds the whole expected run and the chunk cache is off, so that an append writes samples straight to their
place and a flush changes nothing but the length in the object's header: a process killed at any moment leaves a file
that opens. (An index that grows while the process dies is what breaks HDF5 files.) Nothing fills a chunk's room before
it is written: at the first append that would take 26 ms a dataset of a run of ten minutes, the interpreter's lock held.
"""

from __future__ import annotations

from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

_LARGEST = 1 << 30


class Series:
    """An extendable dataset [n] or [n, width]; `add` only collects, `store` appends what was collected."""

    def __init__(
        self, group: h5py.Group, name: str, dtype: Any, *, capacity: int, width: int = 0, units: str = ""
    ) -> None:
        tail = (width,) if width else ()
        row = np.dtype(dtype).itemsize * max(width, 1)
        rows = max(1024, min(capacity, _LARGEST // row))
        self.dataset = group.create_dataset(
            name, shape=(0, *tail), maxshape=(None, *tail), chunks=(rows, *tail), dtype=dtype, fill_time="never"
        )
        if units:
            self.dataset.attrs["units"] = units
        self._dtype = np.dtype(dtype)
        self._parts: list[NDArray[Any]] = []

    def add(self, values: NDArray[Any]) -> None:
        """Keep these rows for the next `store`."""
        self._parts.append(values)

    def __len__(self) -> int:
        """Rows added so far, stored or not."""
        return int(self.dataset.shape[0]) + sum(len(part) for part in self._parts)

    def store(self) -> None:
        """Append everything added so far to the dataset."""
        if not self._parts:
            return
        values = self._parts[0] if len(self._parts) == 1 else np.concatenate(self._parts)
        self._parts = []
        start = self.dataset.shape[0]
        self.dataset.resize(start + len(values), axis=0)
        rows = np.empty(values.shape, self._dtype)  # with h5py's note of the text's encoding, which astype loses
        rows[:] = values
        self.dataset[start:] = rows
