"""`python -m bench`: the table of figures, printed and written to build/bench.json (job, peer, ratio, error)."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from bench import force, models
from bench.models import Row, row

OUT = Path("build/bench.json")
_FIRST = """
import numpy as np, twin.models
from stand.setup import nominal
from twin.model import FibreModel, Start
from twin.plugins import load
m = load(twin.models, {name!r}, FibreModel)
c = m.constants(nominal(), {{}})
out = np.empty((20, 3))
assert m.advance(c, m.start(c, Start()), np.zeros((21, 2)), 5e-4, out) == 0
"""


def first_result(name: str) -> float:
    """Seconds of a fresh process to 20 samples of model `name`, the second of two."""
    seconds = math.inf
    for _ in range(2):
        began = time.perf_counter()
        subprocess.run([sys.executable, "-c", _FIRST.format(name=name)], check=True)
        seconds = time.perf_counter() - began
    return seconds


def against_scipy() -> Row:
    """The force model, taut: LSODA at the tolerance that gives an error of 1e-8."""
    from scipy.integrate import solve_ivp

    drive = np.array(next(iter(force.taut())))
    setup = force.SETUP
    out, seconds = force.run(drive, 1e-13)
    mine = float(np.abs(out[:, 0] - force.refined(drive)).max() / np.ptp(out[:, 0]))
    c1, c2 = (setup.fibre_stiffness * setup.free_length / n for n in _strands())
    tau, rim = setup.fibre_damping / setup.fibre_stiffness, setup.pulley_inertia / setup.pulley_radius**2
    w, a, rest, m = 2 * math.pi * 0.35, 0.025, setup.rest_tension, setup.mass

    def rates(t: float, y: np.ndarray) -> list[float]:
        x, speed = a * (1 - math.cos(w * t)), a * w * math.sin(w * t)
        t1 = rest + c1 * (y[2] - y[0] + tau * (y[3] - y[1]))
        t2 = rest + c2 * (x - y[2] + tau * (speed - y[3]))
        friction = setup.guide_friction * math.tanh(y[1] / setup.guide_friction_velocity)
        return [y[1], (t1 - rest - friction) / m, y[3], (t2 - t1) / rim]

    grid = np.arange(len(drive)) * force.DT
    began = time.perf_counter()
    found = solve_ivp(rates, (0, grid[-1]), [0.0] * 4, "LSODA", grid, rtol=1e-10, atol=1e-13, max_step=0.02)
    theirs = time.perf_counter() - began
    off = float(np.abs(found.y[0, 1:] - out[:, 0]).max() / np.ptp(out[:, 0]))
    note = f"LSODA {theirs:.2f} s, {off:.1e} from ours (its motion is the exact sine, ours its samples)"
    return row("force, taut", "scipy LSODA", theirs / seconds, mine, note)


def _strands() -> tuple[float, float]:
    return force.SETUP.weight_strand_length, force.SETUP.drive_strand_length


def rows() -> Iterator[Row]:
    """All rows, as they come."""
    for name, cases, tolerance in (("taut", force.taut, 1e-13), ("snatch", force.snatching, 1e-13)):
        found = force.single(cases(), tolerance, 0)
        job = f"force, {name}, 10 s"
        yield row(job, "real time", 1e4 / found["ms"], found["error_refined"], f"median of 20: {found['ms']:.2f} ms")
    yield against_scipy()
    yield from models.point_mass()
    yield from models.ancf()
    for name, cases, tolerance, goal in (("taut", force.taut, 1e-7, 1500), ("snatch", force.snatching, 1e-11, 400)):
        found = force.many(cases(), tolerance)
        rate, off = found["runs_per_second"], found["error_refined"]
        yield row(f"many force runs, {name}", f"{goal} runs/s", rate / goal, off, f"{rate:.0f} runs/s")
    found = force.streaming(1_000_000)
    ns = found["ns_per_sample"]
    yield row("streaming R, block of 20", "150 ns", 150 / ns, found["error"], f"{ns:.0f} ns a sample")
    yield from models.fresh(first_result)


def main() -> None:
    """Print each row as it is measured and write them all."""
    print(f"{'job':38} {'peer':14} {'ratio':>9} {'error':>9}  note")
    table = []
    for found in rows():
        table.append(found)
        ratio = "-" if found["ratio"] is None else f"{found['ratio']:.3g}"
        error = "-" if found["error"] is None else f"{found['error']:.1e}"
        print(f"{found['job']:38} {found['peer']:14} {ratio:>9} {error:>9}  {found['note']}", flush=True)
    OUT.parent.mkdir(exist_ok=True)
    OUT.write_text(json.dumps(table, indent=2))
    print(f"written to {OUT}")


if __name__ == "__main__":
    main()
