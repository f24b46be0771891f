"""`kill -9` of the acquisition at random moments: is the file there, and has the drive been stopped?

`python -m tests.loop.kills --count 20` kills in turn during motion, right in a flush, and while the file is closed.
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import h5py

from stand.excitation.spec import Excitation, Shape
from stand.recording import read_recording
from stand.recording.recover import recover
from stand.runs import Phase, RunHandle, RunOrder, start
from tests.loop.ledger import stop_after
from tests.loop.simulated import Simulated, simulated_stand

EXCITATION = Excitation(Shape.TRAPEZOIDAL, 1.25, 0.030, 0.2, 3)
MOMENTS = ("motion", "flush", "close")
STOP_LIMIT, MISSING_LIMIT = 0.25, 1.0


@dataclass(frozen=True)
class Kill:
    """stop: seconds from the kill to the drive's quick stop, None where it had been at rest already.

    missing: seconds between the kill and the newest raw sample in the file; -1 for a file complete by then.
    recovered: seconds of grid after `recover`; what is wrong, if anything.
    """

    moment: str
    stop: float | None
    missing: float
    recovered: float
    wrong: str = ""


def kill_once(simulated: Simulated, folder: Path, moment: str, chance: random.Random) -> Kill:
    """One run, killed at one moment."""
    name = f"{moment}-{chance.randrange(10**9):09d}"
    path = folder / f"{name}.h5"
    handle = start(simulated.stand, RunOrder(EXCITATION, folder=folder, name=name))
    _await_moment(handle, path, moment, chance)
    killed = time.monotonic()
    try:
        os.kill(handle.pid, signal.SIGKILL)
    except ProcessLookupError:  # closed before the kill came: its file is judged all the same
        if moment != "close":
            raise
    handle.wait()
    stop = stop_after(simulated.ledger, killed, wait=1.0) if moment != "close" else None
    return _judge(path, moment, killed, stop)


def _await_moment(handle: RunHandle, path: Path, moment: str, chance: random.Random) -> None:
    wanted = "align" if moment == "close" else "motion"
    for event in handle.events():
        if isinstance(event, Phase) and event.name == wanted:
            break
    else:
        raise RuntimeError(f"the run ended before its {wanted}: {handle.last}")
    if moment == "close":
        time.sleep(chance.uniform(0.0, 0.4))
        return
    time.sleep(chance.uniform(0.1, 2.0))
    if moment == "flush":
        before = path.stat().st_mtime_ns
        while path.stat().st_mtime_ns == before and handle.poll() is None:
            time.sleep(0.0001)


def _judge(path: Path, moment: str, killed: float, stop: float | None) -> Kill:
    try:
        with h5py.File(path, "r") as file:
            complete = bool(file["entry/events"].attrs["complete"])
            newest = min(_newest(group) for group in file["entry/instruments"].values())
        read_recording(path)
        missing = -1.0 if complete else killed - newest
        recovered = 0.0 if complete else recover(path).seconds
        length = len(read_recording(path).time)
    except Exception as error:
        return Kill(moment, stop, float("inf"), 0.0, f"{type(error).__name__}: {error}")
    return Kill(moment, stop, missing, recovered or length / 2000.0, _wrong(moment, missing, stop))


def _newest(group: h5py.Group) -> float:
    return float(group["response_time" if "registers" in group else "arrival_time"][-1])


def _wrong(moment: str, missing: float, stop: float | None) -> str:
    limit = MISSING_LIMIT if moment != "close" else float("inf")  # the readers had ended before
    if missing > limit:
        return f"{missing:.2f} s are missing"
    if moment != "close" and (stop is None or stop > STOP_LIMIT):
        return "the drive was not stopped in time"
    return ""


def main() -> int:
    """Kill, tell, and fail if anything is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    chance, kills = random.Random(options.seed), []
    with tempfile.TemporaryDirectory() as folder, simulated_stand(folder=Path(folder)) as simulated:
        for n in range(options.count):
            kill = kill_once(simulated, Path(folder) / "runs", MOMENTS[n % len(MOMENTS)], chance)
            kills.append(kill)
            stop = "-" if kill.stop is None else f"{kill.stop * 1e3:.0f} ms"
            print(
                f"{n + 1:3d} {kill.moment:7s} stop {stop:>7s}  missing {kill.missing:6.3f} s  {kill.wrong}", flush=True
            )
    stops = [kill.stop for kill in kills if kill.stop is not None]
    wrong = [kill for kill in kills if kill.wrong]
    print(
        f"{len(kills)} kills: {len(kills) - len(wrong)} good; drive stopped within {max(stops) * 1e3:.0f} ms, "
        f"at most {max(kill.missing for kill in kills):.3f} s missing"
    )
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
