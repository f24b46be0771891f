"""What the simulated stand's ledger says, as the measurements ask it."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocks.ledger import read_events, read_samples

#: controlwords, low byte: quick stop (active low) with voltage enabled
QUICK_STOP = 0x0002


def stop_after(ledger: Path, moment: float, wait: float = 2.0) -> float | None:
    """Seconds from `moment` to the first quick stop that reached the drive after it; None where none came."""
    deadline = time.monotonic() + wait + 1.0  # the ledger is flushed twice a second
    while True:
        for event in read_events(ledger):
            if event["kind"] == "controlword" and event["time"] >= moment and _is_quick_stop(event):
                return float(event["time"]) - moment
        if time.monotonic() > deadline:
            return None
        time.sleep(0.05)


def _is_quick_stop(event: dict[str, object]) -> bool:
    return int(str(event["value"])) & 0x86 == QUICK_STOP


def first_above(ledger: Path, instrument: str, limit: float, moment: float, wait: float = 3.0) -> tuple[float, float]:
    """When the first sample above `limit` after `moment` was taken and when handed over, s."""
    deadline = time.monotonic() + wait
    while True:
        samples = read_samples(ledger, instrument)
        found = np.flatnonzero((samples["handed"] >= moment) & (samples["value"] > limit))
        if len(found):
            return float(samples["true_time"][found[0]]), float(samples["handed"][found[0]])
        if time.monotonic() > deadline:
            raise RuntimeError(f"the simulated {instrument} never sent more than {limit}")
        time.sleep(0.1)


def await_sample(ledger: Path, tick: int, wait: float = 3.0) -> None:
    """Until the drive's sample of that number is written, and with it what the gauges had sent by then."""
    deadline = time.monotonic() + wait
    while read_samples(ledger, "drive")["counter"][-1] < tick and time.monotonic() < deadline:
        time.sleep(0.05)


def gauge_values(ledger: Path, instrument: str) -> NDArray[np.float64]:
    """Every value that a gauge handed over, in its order."""
    samples = read_samples(ledger, instrument)
    return np.asarray(samples["value"][np.isfinite(samples["handed"])])


def ring_values(ledger: Path) -> dict[int, float]:
    """The drive's counted samples by their number."""
    samples = read_samples(ledger, "drive")
    return dict(zip(samples["counter"].tolist(), samples["value"].tolist(), strict=True))


def drive_truth(ledger: Path, moments: NDArray[np.float64], wait: float = 2.0) -> NDArray[np.float64]:
    """The drive's true position at these host times, m [n]."""
    deadline = time.monotonic() + wait
    while (samples := read_samples(ledger, "drive"))["true_time"][-1] < moments[-1] and time.monotonic() < deadline:
        time.sleep(0.05)
    return np.interp(moments, samples["true_time"], samples["true_value"])
