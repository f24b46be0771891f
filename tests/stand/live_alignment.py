"""Alignment on real wires, judged against the simulated stand's ledger: `python -m tests.stand.live_alignment`.

A simulated stand is started for each seed, the drive moves, three readers read, and what the time base makes of it is
compared with the true times and positions that the simulated devices noted.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from mocks.ledger import read_samples
from stand.block import Block
from stand.clock import Aligned, GaugeStream, RingStream, align
from stand.config import Stand, load_stand
from stand.drive.drive import Drive
from stand.drive.follow import Followed, follow
from stand.excitation.plan import plan
from stand.excitation.spec import Excitation, Shape
from stand.transport.priority import raise_priority
from stand.transport.raw import Raw, RawBytes, RawRegisters
from stand.transport.readers import GaugeReader, RingReader

BUNCHED = """
[{gauge}]
bunching = 0.016
jitter = [1e-4, 3e-4]
"""
FREQUENCY = {Shape.TRAPEZOIDAL: 1.25, Shape.RECTANGULAR: 1.0, Shape.QUASI_SINUSOIDAL: 0.5}


@contextmanager
def simulated(seed: int, bunched: bool) -> Iterator[tuple[dict[str, Any], Path]]:
    """A simulated stand's announcement and its ledger's folder."""
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "stand.toml"
        config.write_text("".join(BUNCHED.format(gauge=g) for g in ("force_gauge", "dial_gauge")) if bunched else "")
        ledger = Path(folder) / "ledger"
        command = [sys.executable, "-m", "mocks", "serve", str(config), "--seed", str(seed), "--ledger", str(ledger)]
        process = subprocess.Popen(command, stdout=subprocess.PIPE)
        assert process.stdout is not None
        try:
            yield json.loads(process.stdout.readline()), ledger
        finally:
            process.terminate()
            process.wait(20)


def acquire(stand: Stand, order: Excitation) -> tuple[list[Raw], Followed, float]:
    """Everything that came over the wires during one motion, how it went, and the grid's origin."""
    raws: list[Raw] = []
    lock = threading.Lock()

    def sink(raw: Raw, block: Block | None) -> None:
        with lock:
            raws.append(raw)

    def failed(name: str, error: Exception) -> None:
        print(error, file=sys.stderr)

    gauges = [GaugeReader(name, getattr(stand, name)) for name in ("force_gauge", "dial_gauge")]
    with Drive(stand.drive, stand.limits) as drive:
        readers = [*gauges, RingReader(stand)]
        for reader in readers:
            reader.open()
        for gauge in gauges:
            gauge.configure()
        for reader in readers:
            reader.start(sink, failed)
        time.sleep(0.3)
        origin = time.monotonic()
        raise_priority()
        followed = follow(drive, plan(order, stand.limits))
        time.sleep(0.1)
        for reader in readers:
            reader.close()
        drive.disable()
    return raws, followed, origin


def streams_of(raws: list[Raw]) -> dict[str, GaugeStream | RingStream]:
    """The reads as they are stored."""
    polls = [raw for raw in raws if isinstance(raw, RawRegisters)]
    registers = np.array([p.registers for p in polls])
    request, response = np.array([p.request for p in polls]), np.array([p.response for p in polls])
    found: dict[str, GaugeStream | RingStream] = {"drive": RingStream(registers, request, response)}
    for name in ("force_gauge", "dial_gauge"):
        reads = [raw for raw in raws if isinstance(raw, RawBytes) and raw.instrument == name]
        data = np.frombuffer(b"".join(r.data for r in reads), np.uint8)
        found[name] = GaugeStream(data, np.array([r.arrival for r in reads]), np.array([len(r.data) for r in reads]))
    return found


def time_error(aligned: Aligned, ledger: Path, name: str) -> float:
    """The worst time error of an instrument's samples, s; gauges' counts are matched to the ledger's by nearness."""
    rows = read_samples(ledger, name)
    true, clock = rows["true_time"], aligned.clocks[name]
    inside = (true >= aligned.origin) & (true <= aligned.origin + aligned.time[-1])
    if name == "drive":
        index = rows["counter"].astype(np.float64)
    else:
        first = int(np.flatnonzero(inside)[0])
        index = np.arange(len(true)) - first + round((float(true[first]) - clock.offset) / clock.period)
    return float(np.max(np.abs(clock.time_of(index[inside]) - true[inside])))


def position_error(aligned: Aligned, ledger: Path) -> float:
    """x's rms error, m, against the true position at the grid's times."""
    rows = read_samples(ledger, "drive")
    true = np.interp(aligned.origin + aligned.time, rows["true_time"], rows["true_value"])
    error = aligned.channels["drive_position"] - (true - np.median(true[:800]))
    return float(np.sqrt(np.mean(error**2)))


def run(seed: int, shape: Shape, seconds: float, bunched: bool) -> str:
    """One line of the table."""
    cycles = max(1, round((seconds - 2) * FREQUENCY[shape]))
    order = Excitation(shape, FREQUENCY[shape], 0.03, 0.2 if shape is Shape.TRAPEZOIDAL else 0.0, cycles)
    with simulated(seed, bunched) as (announcement, ledger):
        stand = load_stand().with_links(announcement)
        raws, followed, origin = acquire(stand, order)
        time.sleep(0.3)
        count = round(plan(order, stand.limits).duration * 2000)
        aligned = align(streams_of(raws), stand, origin, count)
        errors = [time_error(aligned, ledger, name) * 1e6 for name in ("force_gauge", "dial_gauge", "drive")]
        rms = position_error(aligned, ledger) * 1e6
    stated = aligned.uncertainty["drive_position"] * 1e6
    methods = "/".join(aligned.clocks[name].method for name in ("force_gauge", "dial_gauge"))
    bad = int(np.count_nonzero(aligned.quality))
    row = " ".join(f"{e:9.1f}" for e in errors)
    how = f"{methods}, strayed {followed.worst * 1e3:.2f} mm"
    return f"{seed:4d} {shape:18} {row} {rms:8.2f} {stated:8.2f} {bad:7d}  {how}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--prompt", action="store_true", help="without the adapters' 16 ms timers")
    arguments = parser.parse_args()
    print(f"{'seed':>4} {'shape':18} {'F':>9} {'u':>9} {'x':>9} {'x rms':>8} {'stated':>8} missing  (worst us, um)")
    for seed in range(arguments.first, arguments.first + arguments.seeds):
        for shape in FREQUENCY:
            print(run(seed, shape, arguments.seconds, not arguments.prompt), flush=True)


if __name__ == "__main__":
    main()
