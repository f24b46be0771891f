"""Fresh processes, caches warm, to their first result, checked against the same result made here."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import time
from collections.abc import Iterator

import numpy as np

import twin.models
from bench.row import Row, row
from stand.setup import nominal
from twin.model import FibreModel, Start
from twin.plugins import load, names

_FIRST = """
import numpy as np, twin.models
from stand.setup import nominal
from twin.model import FibreModel, Start
from twin.plugins import load
m = load(twin.models, {name!r}, FibreModel)
c = m.constants(nominal(), {{}})
out = np.empty((20, 3))
drive = np.column_stack([1e-3 * np.arange(21.0) ** 2 / 400, 2e-3 * np.arange(21.0) / 400 / 5e-4])
assert m.advance(c, m.start(c, Start()), drive, 5e-4, out) == 0
print(repr(float(out[-1, 0])))
"""
#: what a user asks for that runs no model
_PLAIN = (["situations"], ["models"], ["profiles"])


def _least(command: list[str], times: int = 4) -> tuple[str, float]:
    """What a command prints and its seconds, the least of some after the first, which warms the caches."""
    seconds, said = math.inf, ""
    for turn in range(times):
        began = time.perf_counter()
        said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        seconds = min(seconds, time.perf_counter() - began) if turn else math.inf
    return said, seconds


def _here(name: str) -> float:
    model = load(twin.models, name, FibreModel)
    c, out, t = model.constants(nominal(), {}), np.empty((20, 3)), np.arange(21.0)
    drive = np.column_stack([1e-3 * t**2 / 400, 2e-3 * t / 400 / 5e-4])
    model.advance(c, model.start(c, Start()), drive, 5e-4, out)
    return float(out[-1, 0])


def rows() -> Iterator[Row]:
    """Every model to 20 samples within 1 s, plain commands within 0.5 s; the error is against the result made here."""
    for name in names(twin.models):
        said, seconds = _least([sys.executable, "-c", _FIRST.format(name=name)])
        yield row(f"fresh process, {name}", "1 s", 1.0 / seconds, abs(float(said) - _here(name)), f"{seconds:.2f} s")
    for arguments in _PLAIN:
        said, seconds = _least([sys.executable, "-m", "api.cli", *arguments, "--json", "-"])
        missing = 0.0 if json.loads(said) else 1.0
        yield row(f"fresh process, stand {' '.join(arguments)}", "0.5 s", 0.5 / seconds, missing, f"{seconds:.2f} s")
