"""How well a simulated stand kept its time, from its ledger: `python -m mocks timing DIR`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mocks.ledger import DROPPED, OVERRUN, read_samples

QUANTILES = (0.0, 50.0, 95.0, 99.0, 100.0)


def timing(folder: Path) -> dict[str, Any]:
    """Per gauge: samples, rate Hz of true time, gaps in the count, overruns, and how long after a sample its frame's
    last byte was handed over, s at QUANTILES per cent; FileNotFoundError where no gauge was read."""
    return {device: _gauge(folder, device) for device in ("force_gauge", "dial_gauge")}


def _gauge(folder: Path, device: str) -> dict[str, Any]:
    rows = read_samples(folder, device)
    counter, true = rows["counter"].astype(np.int64), rows["true_time"]
    after = (rows["handed"] - true)[np.isfinite(rows["handed"])]
    return {
        "samples": len(rows),
        "rate": float((counter[-1] - counter[0]) / (true[-1] - true[0])) if len(rows) > 1 else None,
        "gaps": int(np.count_nonzero(np.diff(counter) != 1)),
        "dropped": int(np.count_nonzero(rows["flags"] & DROPPED)),
        "overrun": int(np.count_nonzero(rows["flags"] & OVERRUN)),
        "handed_after": {f"{q:g}": float(v) for q, v in zip(QUANTILES, np.percentile(after, QUANTILES), strict=True)}
        if len(after)
        else None,
    }


def main_timing(arguments: Sequence[str]) -> int:
    """The command line; 2 where there is no ledger."""
    if len(arguments) != 1 or not (Path(arguments[0]) / "ledger.json").exists():
        print("usage: python -m mocks timing DIR (a folder that `serve --ledger DIR` wrote)")
        return 2
    print(json.dumps(timing(Path(arguments[0])), indent=1))
    return 0
