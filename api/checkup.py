"""What `stand doctor` looks at: the environment, a stand, a recording."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from stand.errors import StandError
from stand.recording import Recording, read_recording
from stand.recording.read import MINIMUM_REST

PACKAGES = ("numpy", "scipy", "numba", "h5py", "pymodbus", "pyserial", "fastapi", "uvicorn", "plotly")
ENOUGH_SPACE = 2e9


@dataclass(frozen=True)
class Check:
    """One thing looked at. state: ok, note or bad."""

    what: str
    state: str
    found: str

    def view(self) -> dict[str, Any]:
        """As JSON."""
        return asdict(self)


def check_environment(tell: Callable[[str], None] = lambda what: None) -> list[Check]:
    """Python, packages, disk, kernels' cache, serial ports, a simulated stand's start."""
    found = [Check("Python", "ok" if sys.version_info >= (3, 11) else "bad", sys.version.split()[0])]
    found += [_package(name) for name in PACKAGES]
    free = shutil.disk_usage(Path.cwd()).free
    found.append(Check("disk", "ok" if free > ENOUGH_SPACE else "note", f"{free / 1e9:.1f} GB free here"))
    found += [_cache(), _serial_ports()]
    tell("starting a simulated stand")
    return [*found, _simulated()]


def _package(name: str) -> Check:
    try:
        return Check(name, "ok", version(name))
    except PackageNotFoundError:
        return Check(name, "bad", "not installed: pip install -e .")


def _cache() -> Check:
    folder = Path(os.environ.get("NUMBA_CACHE_DIR", "") or Path.cwd() / "__pycache__")
    named = "NUMBA_CACHE_DIR" in os.environ
    return Check("compiled kernels", "ok", f"cached in {folder}" if named else "cached beside the sources")


def _serial_ports() -> Check:
    from serial.tools.list_ports import comports

    ports = [port.device for port in comports()]
    return Check("serial ports", "ok" if ports else "note", ", ".join(ports) or "none (a real stand needs two)")


def _simulated() -> Check:
    from api.simulated import SimulatedStand

    try:
        with SimulatedStand() as mock:
            return Check("simulated stand", "ok", f"starts, Modbus TCP at {mock.announcement['drive']['tcp']}")
    except (StandError, OSError) as error:
        return Check("simulated stand", "bad", str(error))


def check_stand(path: Path) -> list[Check]:
    """A configured stand: its file, and whether every device answers."""
    from stand.config import load_stand
    from stand.runs import status

    rig = load_stand(path)
    try:
        answered = status(rig)
    except StandError as error:
        return [Check("stand", "bad", str(error))]
    return [_device(name, answered.get(name)) for name in rig.instruments]


def _device(name: str, answered: object) -> Check:
    """A device's own words, or why it can't be reached."""
    told = dict(answered) if isinstance(answered, Mapping) else {"state": "silent"}
    state = str(told.pop("state", ""))
    if "problem" in told:
        return Check(name, "bad", str(told["problem"]))
    text = ", ".join(
        f"{key} {value:.6g}" if isinstance(value, float) else f"{key} {value}" for key, value in told.items()
    )
    return Check(name, "ok" if state == "ok" else "bad", f"{state}: {text}")


def check_recording(path: Path) -> list[Check]:
    """Whether a recording can be used, and what to know of it."""
    run = read_recording(path)
    seconds = run.time[-1] - run.time[0]
    found = [
        Check("recording", "ok", f"{run.setup.system}, {seconds:.2f} s at {1 / run.dt:.6g} Hz, {len(run.time)} samples")
    ]
    found += [_complete(run), *(_channel(run, name) for name in run.channels), _rest(run), *_quality(run)]
    return found + [Check("note", "note", note) for note in run.notes]


def _complete(run: Recording) -> Check:
    if run.complete is None:
        return Check("closed", "note", "the file does not say")
    if not run.complete and _outcome(run) == "recovered":
        return Check("closed", "note", "cut off, recovered from its raw streams")
    return Check("closed", "ok", "in good order") if run.complete else Check("closed", "bad", "no: try --recover")


def _outcome(run: Recording) -> str:
    import h5py

    assert run.path is not None
    with h5py.File(run.path, "r") as file:
        return str(file["entry/events"].attrs.get("outcome", ""))


def _channel(run: Recording, name: str) -> Check:
    values = run.channels[name]
    wrong = int(np.count_nonzero(~np.isfinite(values)))
    if wrong:
        return Check(name, "bad", f"{wrong} of {len(values)} samples are no number")
    if np.ptp(values) == 0.0:
        return Check(name, "bad", f"constant at {values[0]:.6g}: is the gauge connected?")
    clipped = max(np.count_nonzero(values == values.max()), np.count_nonzero(values == values.min())) / len(values)
    text = f"{values.min():.6g} to {values.max():.6g}"
    return (
        Check(name, "note", f"{text}, {100 * clipped:.1f} % at one end: clipped?")
        if clipped > 0.2
        else Check(name, "ok", text)
    )


def _rest(run: Recording) -> Check:
    moving = next((run.channels[n] for n in ("drive_position", "weight_position") if n in run.channels), run.time)
    count = round(MINIMUM_REST / run.dt)
    still = float(np.ptp(moving[:count])) < 0.02 * float(np.ptp(moving)) + 1e-9
    return Check(
        "rest at the beginning", "ok" if still else "note", "0.4 s" if still else "moves within the first 0.4 s"
    )


def _quality(run: Recording) -> list[Check]:
    if run.quality is None:
        return []
    marked = float(np.mean(run.quality != 0))
    return [Check("quality", "ok" if marked == 0 else "note", f"{100 * marked:.3g} % of samples marked")]
