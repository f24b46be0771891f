"""From the sample that shows a fault to the quick stop on the wire, over many trips.

`python -m tests.loop.trips --count 40` provokes a force above its limit while the drive moves, and reads both moments
from the simulated stand's ledger: when the faulty sample was taken and handed over, and when the stop arrived.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stand.excitation.spec import Excitation, Shape
from stand.recording import read_recording
from stand.runs import Finished, Outcome, Phase, RunOrder, start
from tests.loop.ledger import first_above, stop_after
from tests.loop.simulated import Simulated, simulated_stand

EXCITATION = Excitation(Shape.TRAPEZOIDAL, 1.25, 0.030, 0.2, 3)
LIMIT = 0.020
#: rules that the force of 1500 N breaks: the limit, and the gauge's own overload flag
CAUSES = ("force", "device flag")


@dataclass(frozen=True)
class TripTime:
    """Seconds to the stop's arrival at the drive: from the sample's taking, and from its arrival at the host."""

    from_sample: float
    from_arrival: float
    finished: Finished


def trip_once(simulated: Simulated, folder: Path, wait: float) -> TripTime:
    """One run, tripped by a force of 1500 N `wait` s into its motion."""
    stand = simulated.stand
    handle = start(stand, RunOrder(EXCITATION, folder=folder))
    for event in handle.events():
        if isinstance(event, Phase) and event.name == "motion":
            break
    time.sleep(wait)
    before = time.monotonic()
    simulated.control("spike force_gauge 1500 0.05")
    last = handle.wait()
    if not isinstance(last, Finished) or last.outcome is not Outcome.TRIPPED:
        raise RuntimeError(f"the run did not trip: {last}")
    if last.trip is None or last.trip.rule not in CAUSES:
        raise RuntimeError(f"the run tripped for another reason than too large a force: {last.why}")
    taken, handed = first_above(simulated.ledger, "force_gauge", stand.limits.force[1], before)
    stopped = before + (stop_after(simulated.ledger, before) or float("inf"))
    return TripTime(stopped - taken, stopped - handed, last)


def main() -> int:
    """Trip, tell the percentiles, and fail above 20 ms at the 99th."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    chance, trips = random.Random(options.seed), []
    with tempfile.TemporaryDirectory() as folder, simulated_stand(folder=Path(folder)) as simulated:
        for n in range(options.count):
            trip = trip_once(simulated, Path(folder) / "runs", chance.uniform(0.1, 1.5))
            assert trip.finished.path is not None
            read_recording(trip.finished.path)
            trips.append(trip)
            print(f"{n + 1:3d} {trip.from_sample * 1e3:6.2f} ms, {trip.from_arrival * 1e3:6.2f} ms of it on our side")
    total = np.percentile([trip.from_sample for trip in trips], [50, 99, 100]) * 1e3
    ours = np.percentile([trip.from_arrival for trip in trips], [50, 99, 100]) * 1e3
    print(f"sample to stop on the wire: median {total[0]:.2f}, 99 % {total[1]:.2f}, worst {total[2]:.2f} ms")
    print(f"of it since its arrival:    median {ours[0]:.2f}, 99 % {ours[1]:.2f}, worst {ours[2]:.2f} ms")
    return 0 if total[1] <= LIMIT * 1e3 else 1


if __name__ == "__main__":
    sys.exit(main())
