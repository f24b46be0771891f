"""`python -m tests.blind --seed 7 --out build/blind`: the battery; the same command goes on where it stopped."""

from __future__ import annotations

import argparse
import json
import subprocess
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from mocks.battery.draw import KINDS, RUNS, Case, battery
from tests.blind.stand import diagnose_case, result_path
from tests.blind.table import table


def main(argv: Sequence[str] | None = None) -> int:
    """The command line."""
    given = _arguments(argv)
    short = f"-runs-{given.runs}" if given.runs < RUNS else ""
    out = given.out / f"seed-{given.seed}{short}"
    out.mkdir(parents=True, exist_ok=True)
    cases = battery(given.seed, given.kinds, given.share, given.runs)
    if not given.table:
        _run(cases, out, given.processes, given.keep)
    results = [json.loads(p.read_text()) for case in cases if (p := result_path(case, out)).exists()]
    head = f"seed {given.seed}, runs {given.runs}, version {_version()}, {len(results)} of {len(cases)} stands"
    text = f"{head}\n\n{table(results)}\n"
    (out / "table.txt").write_text(text)
    print(text)
    return 0


def _arguments(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.blind", description=__doc__)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--out", type=Path, default=Path("build/blind"))
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--share", type=float, default=1.0, help="part of each kind")
    parser.add_argument("--runs", type=int, choices=range(1, RUNS + 1), default=RUNS, help="of each campaign")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--keep", action="store_true", help="keep the recordings (1.5 MB a run)")
    parser.add_argument("--table", action="store_true", help="only print the table of what is done")
    return parser.parse_args(argv)


def _run(cases: Sequence[Case], out: Path, processes: int, keep: bool) -> None:
    left = [case for case in cases if not result_path(case, out).exists()]
    with ProcessPoolExecutor(processes) as pool:
        jobs = [pool.submit(diagnose_case, case, out, keep) for case in left]
        for done, job in enumerate(as_completed(jobs), 1):
            result = job.result()
            named = ", ".join(result.get("named", [])) or result.get("error", "nothing")
            hidden = ", ".join(result["hidden"]) or "nothing"
            print(f"{done:4d}/{len(left)} {result['outcome']:9s} hidden: {hidden}; named: {named}", flush=True)


def _version() -> str:
    """The commit that was measured."""
    told = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True, check=False)
    return told.stdout.strip() or "unknown"


if __name__ == "__main__":
    raise SystemExit(main())
