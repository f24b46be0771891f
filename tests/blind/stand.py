"""One stand of a battery: written, diagnosed through the files alone, judged, forgotten."""

from __future__ import annotations

import json
import os
import time
from pathlib import Path
from typing import Any

os.environ.setdefault("NUMBA_NUM_THREADS", "1")

from mocks.battery.draw import Case
from mocks.battery.store import forget, read_answer, write
from tests.blind.judge import judge


def result_path(case: Case, out: Path) -> Path:
    """Where a stand's result is kept; where it exists, the stand is done."""
    return out / f"{case.name}.json"


def diagnose_case(case: Case, out: Path, keep: bool = False) -> dict[str, Any]:
    """The judgement on one stand, written to its result file."""
    from stand.recording import read_recording
    from twin.diagnosis import diagnose

    place = write(case, out / "stands")
    files = sorted(place.glob("run-*.h5"))
    begin = time.perf_counter()
    try:
        verdict = diagnose([read_recording(f) for f in files])
        content = judge(read_answer(place), verdict.to_json(), time.perf_counter() - begin)
        content["verdict"] = verdict.to_json()
    except Exception as error:  # a crash is a result, too: the table counts it
        content = {"number": case.number, "kind": case.kind, "hidden": list(case.hidden), "error": repr(error)}
        content |= {"outcome": "error", "wanted": list(case.wanted.values())}
    result_path(case, out).write_text(json.dumps(content))
    if not keep:
        forget(place)
    return content
