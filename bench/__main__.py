"""`python -m bench`: the table of figures, printed and written to build/bench.json (job, peer, ratio, error)."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from bench import force, force_rows, fresh, models
from bench.row import Row, row

OUT = Path("build/bench.json")


def rows() -> Iterator[Row]:
    """All rows, as they come."""
    yield from force_rows.rows()
    yield from models.point_mass()
    yield from models.ancf()
    found = force.streaming()
    ns = found["ns_per_sample"]
    yield row("streaming R, block of 20", "150 ns", 150 / ns, found["error"], f"{ns:.0f} ns a sample, 1 h at 2 kHz")
    yield from fresh.rows()


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
