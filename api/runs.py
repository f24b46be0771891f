"""The folder of runs: recordings, and what was computed beside them under the same name."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from api.problem import NotFound
from stand.errors import StandError

#: what may lie beside NAME.h5, by its ending
BESIDE = {
    "comparison": ".comparison.json",
    "comparison-page": ".comparison.html",
    "diagnosis": ".diagnosis.json",
    "diagnosis-page": ".diagnosis.html",
    "model": ".model.toml",
}


def beside(recording: Path, kind: str) -> Path:
    """Where `kind` of BESIDE lies for a recording."""
    return recording.with_name(recording.stem + BESIDE[kind])


@dataclass
class Runs:
    """Lists and finds runs in `folder`; what a file says is read once and kept while the file stays the same."""

    folder: Path
    _read: dict[tuple[str, int, int], dict[str, Any]] = field(default_factory=dict)

    def list(self) -> list[dict[str, Any]]:
        """A summary of each recording, newest first."""
        files = [file for file in self.folder.glob("*.h5") if not file.name.startswith(".")]
        return [self.summary(file) for file in sorted(files, key=lambda file: file.stat().st_mtime, reverse=True)]

    def path(self, name: str) -> Path:
        """The recording `name` (without ending); NotFound, also for a name that would leave the folder."""
        path = self.folder / f"{name}.h5"
        if Path(name).name != name or not path.is_file():
            raise NotFound("no such run", where="runs", value=name, remedy="GET /runs lists them")
        return path

    def file(self, name: str, kind: str) -> Path:
        """What lies beside the run `name`; NotFound while it is not there."""
        path = beside(self.path(name), kind)
        if not path.is_file():
            raise NotFound(f"no {kind.replace('-', ' ')} of this run yet", where=name, remedy="GET /runs/NAME says why")
        return path

    def summary(self, file: Path) -> dict[str, Any]:
        """Name, time, size, what the file says, scores, and which results lie beside it."""
        stat = file.stat()
        key = (file.name, stat.st_size, stat.st_mtime_ns)
        told = self._read.get(key) or _describe(file)
        if told["readable"]:  # a file that is being recorded is locked, and readable later
            self._read[key] = told
        found = [kind for kind in BESIDE if beside(file, kind).is_file()]
        written = datetime.fromtimestamp(stat.st_mtime, UTC).isoformat(timespec="seconds")
        links = {kind: f"/runs/{file.stem}/{kind}" for kind in found} | {"file": f"/runs/{file.stem}/file"}
        return {
            "name": file.stem,
            "written": written,
            "bytes": stat.st_size,
            **told,
            "scores": _scores(file),
            "verdict": _verdict(file),
            "links": links,
        }


def _describe(file: Path) -> dict[str, Any]:
    from stand.recording import read_recording

    try:
        recording = read_recording(file)
    except StandError as error:
        return {"readable": False, "why": str(error)}
    excitation = recording.excitation
    return {
        "readable": True,
        "complete": recording.complete,
        "seconds": round(float(recording.time[-1] - recording.time[0]), 3),
        "system": str(recording.setup.system),
        "added_mass": recording.setup.added_mass,
        "shape": str(excitation.shape) if excitation else None,
        "frequency": excitation.frequency if excitation else None,
        "amplitude": excitation.amplitude if excitation else None,
    }


def _verdict(file: Path) -> dict[str, Any] | None:
    """The diagnosis in short: causes' names, whether something unknown is left, and why to run what next."""
    try:
        verdict = json.loads(beside(file, "diagnosis").read_text())
        causes = [cause["name"] for cause in verdict["causes"]]
        proposal = verdict.get("next_experiment") or {}
        return {"causes": causes, "unknown": verdict.get("unknown") is not None, "next": proposal.get("why")}
    except (OSError, ValueError, KeyError):
        return None


def _scores(file: Path) -> dict[str, Any] | None:
    path = beside(file, "comparison")
    try:
        run = json.loads(path.read_text())["baseline"]["runs"][0]
    except (OSError, ValueError, KeyError, IndexError):
        return None
    return {channel: values for channel, values in run.items() if isinstance(values, dict)}
