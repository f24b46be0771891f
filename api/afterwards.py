"""What is computed from recordings, and where it goes: used by the command line and by the server's worker."""

from __future__ import annotations

import json
import os
import pkgutil
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from api.runs import beside
from stand.errors import StandError
from stand.recording import read_recording
from stand.targets import check_target

Tell = Callable[[str, float | None], None]


def compare_run(
    recording: Path, models: Sequence[str], tell: Tell, *, json_file: Path | None = None, page: Path | None = None
) -> dict[str, Any]:
    """Compare a recording with models and write JSON and page (beside it where no paths are given).

    Returns {"json", "page", "comparison"}.
    """
    from twin.compare import compare
    from twin.report import comparison_page

    tell("reading", None)
    _check_targets(json_file, page)
    run = read_recording(recording)
    comparison = compare(run, models=tuple(models), progress=tell)
    json_file, page = json_file or beside(recording, "comparison"), page or beside(recording, "comparison-page")
    content = comparison.to_json()
    write_text(json_file, json.dumps(content, indent=2, allow_nan=False) + "\n")
    tell("writing the page", None)
    comparison_page(comparison, page)
    return {"json": str(json_file), "page": str(page), "comparison": content}


def diagnose_runs(
    recordings: Sequence[Path], tell: Tell, *, json_file: Path | None = None, page: Path | None = None, **options: Any
) -> dict[str, Any]:
    """Diagnose a recording or a campaign, where damaged files are skipped and listed: {"json", "page", "verdict"}.

    Where no paths are given, the results go beside the last recording.
    """
    from twin.diagnosis import diagnose

    _check_targets(json_file, page)
    runs, skipped = [], []
    for path in recordings:
        try:
            runs.append(read_recording(path))
        except StandError as error:
            if len(recordings) == 1:
                raise
            skipped.append({"file": path.name, "why": str(error)})
    verdict = diagnose(runs, skipped=skipped, progress=tell, **options)
    json_file, page = json_file or beside(recordings[-1], "diagnosis"), page or beside(recordings[-1], "diagnosis-page")
    tell("writing the verdict", None)
    written = verdict.write(json_file, page if _has_page() else None)
    return {"json": str(json_file), "page": str(page) if _has_page() else None, "verdict": written.to_json()}


def _check_targets(json_file: Path | None, page: Path | None) -> None:
    """Before any computing: where the results shall go must be a place for them."""
    for path, option in ((json_file, "--json"), (page, "--page")):
        if path is not None:
            check_target(path, option)


def _has_page() -> bool:
    """Whether this version draws the verdict's page."""
    import twin.report

    return any(module.name == "diagnosis" for module in pkgutil.iter_modules(twin.report.__path__))


def write_text(path: Path, text: str) -> None:
    """Write at once or not at all."""
    partial = path.with_name(f".{path.name}.{os.getpid()}")
    partial.write_text(text)
    partial.replace(path)
