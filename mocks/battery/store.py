"""A battery's stands on disk, each written when it is wanted: a runner can stop and go on."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mocks.battery.draw import Case
from mocks.battery.settle import settled
from mocks.record import record, told, write_truth

TRUTH = "truth.json"


def write(case: Case, folder: Path, seconds: float = 10.0) -> Path:
    """The case's own folder with run-1.h5 ... and truth.json, which is written last: where it is, nothing is done."""
    place = folder / case.name
    if (place / TRUTH).exists():
        return place
    place.mkdir(parents=True, exist_ok=True)
    case, strengths = settled(case)
    for k, motion in enumerate(case.motions, 1):
        path = place / f"run-{k}.h5"
        record(case.stand, motion, path=path, seconds=seconds, seed=case.seed + k, hidden=case.hidden, noise=case.noise)
        path.with_suffix(".truth.json").unlink()
    write_truth(place / "truth.h5", answer(case, strengths)).rename(place / TRUTH)
    return place


def answer(case: Case, strengths: Mapping[str, float]) -> dict[str, Any]:
    """What a right diagnosis would say; strengths as measured on this stand."""
    hidden = [
        told(name, values) | {"wanted_strength": case.wanted[name], "strength": strengths[name]}
        for name, values in case.hidden.items()
    ]
    return {"kind": case.kind, "hidden": hidden, "seed": case.seed, "number": case.number}


def read_answer(place: Path) -> dict[str, Any]:
    """The truth of a stand on disk."""
    content: dict[str, Any] = json.loads((place / TRUTH).read_text())
    return content


def forget(place: Path) -> None:
    """Removes a stand's recordings but keeps its truth."""
    for path in place.glob("*.h5"):
        path.unlink()
