"""What the simulated stand knows of itself: every sample that it sent, with the truth beside it.

A folder holds one `<device>.bin` per device, records of `DTYPE` one after another (readable after a kill: a record
that was cut is dropped), `events.jsonl` (one JSON object a line: `time` CLOCK_MONOTONIC s, `kind`, facts), and
`ledger.json` that names all this. Values and true values share the device's own zero; `zero` in ledger.json is what
the device shows at the plant's zero.
"""

from __future__ import annotations

import json
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, TextIO

import numpy as np
from numba import njit
from numpy.typing import NDArray

Float = NDArray[np.float64]

FAULTY, DROPPED, SPOILT, OVERRUN = 1, 2, 4, 8
#: counter: samples taken before this one; tick: device time s; true_time: CLOCK_MONOTONIC s of the sample;
#: value: as a reader decodes it; true_value: without noise, quantisation and hidden sensor effects;
#: handed: CLOCK_MONOTONIC s when its last byte was handed over (NaN: never); flags: the sum of the above
DTYPE = np.dtype(
    [
        ("counter", "<u8"), ("tick", "<f8"), ("true_time", "<f8"), ("value", "<f8"), ("true_value", "<f8"),
        ("handed", "<f8"), ("flags", "<u8"),
    ]
)  # fmt: skip


@dataclass
class Rows:
    """Samples under way, every field [n]. due: when the last byte leaves; place: bytes sent up to and with it.

    clean: no flag is set.
    """

    counter: NDArray[np.int64]
    tick: Float
    true_time: Float
    value: Float
    true_value: Float
    handed: Float
    flags: NDArray[np.int64]
    due: Float
    place: NDArray[np.int64]
    clean: bool = True

    @classmethod
    def of(cls, counter: NDArray[np.int64], tick: Float, true_time: Float, value: Float, true_value: Float) -> Rows:
        """Fresh samples."""
        zeros, unknown = np.zeros((2, len(counter)), np.int64), np.full((2, len(counter)), np.nan)
        return cls(counter, tick, true_time, value, true_value, unknown[0], zeros[0], unknown[1], zeros[1])

    def __len__(self) -> int:
        return len(self.counter)

    def split(self, count: int) -> tuple[Rows, Rows]:
        """The first `count` samples and the others."""
        fields = [getattr(self, name) for name in self.__dataclass_fields__ if name != "clean"]
        first, rest = Rows(*(f[:count] for f in fields)), Rows(*(f[count:] for f in fields))
        first.clean = rest.clean = self.clean
        return first, rest

    def records(self) -> bytes:
        """As the file has them."""
        packed = np.empty((len(self), 7), np.uint64)
        _pack(self.counter, self.tick, self.true_time, self.value, self.true_value, self.handed, self.flags, packed)
        return packed.tobytes()


@njit(cache=True)
def _pack(counter, tick, true_time, value, true_value, handed, flags, out):  # type: ignore[no-untyped-def]
    """Seven fields of eight bytes [n] as records, uint64 [n, 7]."""
    t, s, v, w, h = (
        tick.view(np.uint64), true_time.view(np.uint64), value.view(np.uint64), true_value.view(np.uint64),
        handed.view(np.uint64),
    )  # fmt: skip
    for i in range(counter.size):
        out[i, 0], out[i, 6] = np.uint64(counter[i]), np.uint64(flags[i])
        out[i, 1], out[i, 2], out[i, 3], out[i, 4], out[i, 5] = t[i], s[i], v[i], w[i], h[i]


class Ledger:
    """Writes a folder; `flush` at least twice a second keeps it readable after a kill."""

    def __init__(self, folder: Path, facts: dict[str, Any]) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self._files: dict[str, BinaryIO] = {}
        self._waiting: dict[str, bytearray] = {}
        self._lock = threading.Lock()
        self._events: TextIO = (folder / "events.jsonl").open("w")
        self.describe(facts)

    def describe(self, facts: dict[str, Any]) -> None:
        """ledger.json: the records' layout and the facts."""
        header = {"dtype": DTYPE.descr, "flags": {"faulty": 1, "dropped": 2, "spoilt": 4, "overrun": 8}, **facts}
        (self.folder / "ledger.json").write_text(json.dumps(header, indent=1) + "\n")

    def rows(self, device: str, rows: Rows) -> None:
        """Samples of a device; in the file with the next `flush`. Nobody changes the rows any more."""
        with self._lock:
            self._waiting.setdefault(device, bytearray()).extend(rows.records())

    def event(self, time: float, kind: str, **facts: Any) -> None:
        """Something that happened."""
        self._events.write(json.dumps({"time": time, "kind": kind, **facts}) + "\n")

    def flush(self) -> None:
        """All that is written so far, to the system."""
        self._events.flush()
        with self._lock:
            waiting, self._waiting = self._waiting, {}
        for device, records in waiting.items():
            if device not in self._files:
                self._files[device] = (self.folder / f"{device}.bin").open("wb", buffering=1 << 20)
            self._files[device].write(records)
            self._files[device].flush()

    def close(self) -> None:
        """The end."""
        self.flush()
        self._events.close()
        for file in self._files.values():
            file.close()


def read_samples(folder: Path | str, device: str) -> NDArray[np.void]:
    """A device's samples, DTYPE [n]; FileNotFoundError where it sent none."""
    data = (Path(folder) / f"{device}.bin").read_bytes()
    return np.frombuffer(data[: len(data) // DTYPE.itemsize * DTYPE.itemsize], DTYPE)


def read_events(folder: Path | str) -> list[dict[str, Any]]:
    """Everything that happened, in order; a last line that was cut is dropped."""
    text = (Path(folder) / "events.jsonl").read_text()
    return [json.loads(line) for line in text[: text.rfind("\n") + 1].splitlines()]
