"""What all commands print with: results on stdout, progress and remarks on stderr, JSON where asked."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any, Protocol

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.table import Table

from stand.targets import check_target

#: where stdout is no terminal, lines are long rather than broken
out = Console(highlight=False, width=None if sys.stdout.isatty() else 160, soft_wrap=not sys.stdout.isatty())
err = Console(stderr=True, highlight=False)

JsonOption = Annotated[
    Path | None, typer.Option("--json", metavar="FILE", help="Write the result as JSON too; - is stdout.")
]


def write_json(result: object, path: Path | None) -> None:
    """Write `result` to `path` (atomically) or to stdout for `-`; nothing where path is None."""
    if path is None:
        return
    text = json.dumps(result, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    if str(path) == "-":
        sys.stdout.write(text)
        return
    check_target(path, "--json")
    partial = path.with_name(f".{path.name}.{os.getpid()}")
    partial.write_text(text)
    partial.replace(path)


def quiet(path: Path | None) -> bool:
    """Whether stdout is taken by JSON, so that tables stay away from it."""
    return path is not None and str(path) == "-"


class Report(Protocol):
    """How long work tells how far it is: a clause and a fraction of 1 (None where unknown)."""

    def __call__(self, what: str, fraction: float | None = None, /) -> None: ...


@contextmanager
def progress(title: str) -> Iterator[Report]:
    """A progress bar on stderr, gone when the work is done; silent where stderr is no terminal."""
    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(bar_width=24), TimeElapsedColumn())
    with Progress(*columns, console=err, transient=True, disable=not err.is_terminal) as bar:
        task = bar.add_task(title, total=None)

        def report(what: str, fraction: float | None = None) -> None:
            bar.update(task, description=what or title, total=None if fraction is None else 1.0, completed=fraction)

        yield report


def table(title: str, columns: Sequence[str], rows: Sequence[Sequence[object]], *, right: Sequence[str] = ()) -> Table:
    """A table with its columns named in `right` set flush right; None shows as a dash."""
    made = Table(title=title, title_justify="left", header_style="bold", box=None, pad_edge=False)
    for name in columns:
        made.add_column(name, justify="right" if name in right else "left", overflow="fold")
    for row in rows:
        made.add_row(*(cell(value) for value in row))
    return made


def cell(value: object) -> str:
    """Text of one cell: four significant figures for a float, a dash for None."""
    if value is None:
        return "–"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def score_rows(scores: Mapping[str, Mapping[str, Any]]) -> list[list[object]]:
    """Rows channel, R, ceiling, NRMSE, lag in ms, gain, peak error out of a `baseline` entry."""
    keys = ("R", "R_ceiling", "nrmse", "lag_s", "gain", "peak_error")
    rows: list[list[object]] = []
    for channel, values in scores.items():
        found: list[object] = [values.get(key) for key in keys]
        lag = found[3]
        found[3] = None if lag is None else 1e3 * float(lag)  # type: ignore[arg-type]
        rows.append([channel, *found])
    return rows
