"""How well three channels land on one time base, over many seeds with known truth: `python -m tests.stand.alignment`.

Clocks drawn within 50 ppm (every fifth seed: exactly right), arrivals bunched by a 16 ms timer that is up to 0.3 % off
and handed over 0.1 to 0.3 ms late; the links' latencies are configured wrong by one sigma, up and down in turn.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np

from stand.clock import Aligned, align
from stand.excitation.spec import Shape
from tests.stand.wires import Wires, draw


@dataclass(frozen=True, slots=True)
class Outcome:
    """Worst time error of each instrument's samples, s; x's rms error m and what the file would state for it."""

    force_gauge: float
    dial_gauge: float
    drive: float
    x_rms: float
    x_stated: float
    missing: int


def judge(wires: Wires) -> Outcome:
    """Align and compare with the truth."""
    aligned = align(wires.streams, wires.stand, wires.origin, wires.count)
    worst = {name: time_error(wires, aligned, name) for name in wires.epochs}
    x = wires.truth["drive"] - float(np.median(wires.truth["drive"][:800]))
    rms = float(np.sqrt(np.mean((aligned.channels["drive_position"] - x) ** 2)))
    stated = aligned.uncertainty["drive_position"]
    return Outcome(
        worst["force_gauge"], worst["dial_gauge"], worst["drive"], rms, stated, int(np.count_nonzero(aligned.quality))
    )


def time_error(wires: Wires, aligned: Aligned, name: str) -> float:
    """The worst time error of an instrument's samples over the run, s."""
    clock, epoch, period = aligned.clocks[name], wires.epochs[name], wires.periods[name]
    ends = np.array([wires.origin, wires.origin + wires.count / 2000])
    index = (ends - epoch) / period
    return float(np.max(np.abs(clock.time_of(index) - ends)))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--timer", type=float, default=0.016, help="s; 0 for prompt arrivals")
    arguments = parser.parse_args()
    print(f"{'shape':18} {'F worst':>9} {'u worst':>9} {'x worst':>9} {'x rms':>8} {'stated':>8}  missing   (us, um)")
    for shape in (Shape.TRAPEZOIDAL, Shape.RECTANGULAR, Shape.QUASI_SINUSOIDAL):
        found = [
            judge(draw(seed, shape, timer=arguments.timer or None, wrong_by_sigma=1.0 if seed % 2 else -1.0))
            for seed in range(arguments.seeds)
        ]
        times = [max(getattr(o, name) for o in found) * 1e6 for name in ("force_gauge", "dial_gauge", "drive")]
        rms, stated = (max(getattr(o, name) for o in found) * 1e6 for name in ("x_rms", "x_stated"))
        row = " ".join(f"{t:9.1f}" for t in times)
        print(f"{shape:18} {row} {rms:8.2f} {stated:8.2f} {max(o.missing for o in found):8d}", flush=True)


if __name__ == "__main__":
    main()
