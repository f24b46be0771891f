"""Where a comparison's numbers come from."""

from __future__ import annotations

import hashlib
import platform
from datetime import UTC, datetime
from importlib import metadata
from typing import Any

from stand.recording import Recording
from stand.setup import SCALARS
from stand.units import conversion


def provenance(recording: Recording) -> dict[str, Any]:
    """The file and its digest, versions, time (UTC), and the setup with its uncertainties, in the file's units."""
    return {
        "file": recording.name,
        "sha256": _digest(recording),
        "samples": len(recording.time),
        "duration_s": float(recording.time[-1] - recording.time[0]),
        "rate_hz": 1.0 / recording.dt,
        "compared": datetime.now(UTC).isoformat(timespec="seconds"),
        "software": {"fibre-stand": _version("fibre-stand"), "python": platform.python_version()}
        | {name: _version(name) for name in ("numpy", "numba", "h5py")},
        "setup": _setup(recording),
    }


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "unknown"


def _digest(recording: Recording) -> str | None:
    if recording.path is None or not recording.path.exists():
        return None
    with recording.path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _setup(recording: Recording) -> dict[str, Any]:
    setup, made = recording.setup, {"system": {"value": str(recording.setup.system)}}
    for name, unit in SCALARS.items():
        value = getattr(setup, name)
        if value is not None:
            factor = conversion(unit, unit)
            stated = name in setup.uncertainty
            sigma = {"uncertainty": setup.sigma(name) / factor, "stated": stated}
            made[name] = {"value": value / factor, "units": unit} | sigma
    return made
