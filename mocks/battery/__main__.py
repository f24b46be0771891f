"""`python -m mocks.battery --seed 7 --out DIR`: writes the stands of a battery, or lists what it would hide."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from mocks.battery.draw import KINDS, battery
from mocks.battery.store import write


def main(argv: Sequence[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m mocks.battery", description=__doc__)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--out", type=Path, help="folder; without it the stands are only listed, with what they hide")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--share", type=float, default=1.0, help="part of each kind, for a quick look")
    given = parser.parse_args(argv)
    for case in battery(given.seed, given.kinds, given.share):
        if given.out:
            print(write(case, given.out))
        else:
            print(case.name, case.kind, *(f"{name} {dict(values)}" for name, values in case.hidden.items()))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
