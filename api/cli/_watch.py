"""A run in the terminal: its phase, the newest samples and the live scores, redrawn a few times a second."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rich.console import Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from api.cli._console import cell, err, progress
from api.experiment import Experiment, State
from api.follow import Follower
from api.live import score_view

if TYPE_CHECKING:
    from api.twins import Beside
    from stand.clock import LiveBlock
    from stand.config import Stand
    from stand.runs import RunHandle, RunOrder
    from twin.live import LiveScore

SHOWN_EVERY = 0.15
GOOD = frozenset({State.FINISHED, State.STOPPED})


def run_and_watch(
    stand: Stand, order: RunOrder, *, model: str | None, seconds: float, title: str
) -> tuple[Experiment, Beside | None]:
    """Run an order to its end: the last record and the twin beside. Ctrl-C stops in good order."""
    from api.twins import Beside, make_twin
    from stand.runs import PHASES, start

    setup = order.setup or stand.setup
    with progress("preparing the model (it compiles once)"):
        twin = make_twin(model, setup) if model else None
    beside = Beside(lambda: twin) if twin else None
    handle = start(stand, order)
    experiment = Experiment("run", {}, model or "", "", PHASES, seconds)
    with Live(console=err, auto_refresh=False, transient=False) as live:
        screen = _Screen(live, title)
        follower = Follower(experiment, beside, changed=screen.changed, sampled=screen.sampled)
        experiment = _follow(follower, handle)
    if not err.is_terminal:
        err.print()  # what follows begins a line of its own
    return experiment, beside


def _follow(follower: Follower, handle: RunHandle) -> Experiment:
    while True:
        try:
            return follower.follow(handle.events())
        except KeyboardInterrupt:
            err.print("[bold]stopping in good order; once more for a quick stop")
            try:
                handle.stop("Ctrl-C")
                return follower.follow(handle.events())
            except KeyboardInterrupt:
                handle.emergency_stop("Ctrl-C twice")


class _Screen:
    """What the terminal shows of a run."""

    def __init__(self, live: Live, title: str) -> None:
        self._live, self._title, self._shown = live, title, 0.0
        self._experiment: Experiment | None = None
        self._values: dict[str, float] = {}
        self._score: Mapping[str, Any] = {}

    def changed(self, experiment: Experiment) -> None:
        """A new record."""
        self._experiment = experiment
        self._show(force=not experiment.active)

    def sampled(self, block: LiveBlock, score: LiveScore | None, latency: float) -> None:
        """New samples."""
        self._values |= {"x": 1e3 * float(block.x[-1]), "u": 1e3 * float(block.u[-1]), "F": float(block.F[-1])}
        if score is not None:
            self._score = score_view(score)
            if len(score.simulated_u):
                self._values |= {"u_sim": 1e3 * float(score.simulated_u[-1]), "F_sim": float(score.simulated_F[-1])}
        self._show()

    def _show(self, *, force: bool = False) -> None:
        now = time.monotonic()
        if self._experiment is None or (not force and now - self._shown < SHOWN_EVERY):
            return
        self._shown = now
        parts = [self._head(self._experiment)]
        if self._values:
            parts.append(self._table())
        self._live.update(Group(*parts), refresh=True)

    def _head(self, experiment: Experiment) -> Table:
        head = Table.grid(padding=(0, 2))
        state = experiment.phase if experiment.active else str(experiment.state)
        tone = "green" if experiment.state in GOOD else "cyan" if experiment.active else "bold red"
        bar = ProgressBar(total=1.0, completed=experiment.view()["progress"], width=30)
        clock = f"{min(experiment.elapsed, experiment.seconds):5.1f} / {experiment.seconds:.1f} s"
        head.add_row(Text(self._title, style="bold"), Text(f"{state:<9}", style=tone), bar, clock)
        return head

    def _table(self) -> Table:
        table = Table(box=None, header_style="dim", pad_edge=False)
        for name in ("channel", "measured", "simulated", "R", "R sliding", "NRMSE", "window error"):
            table.add_column(name, justify="left" if name == "channel" else "right", no_wrap=True)
        for key, title, unit in (("u", "weight u", "mm"), ("F", "force F", "N"), ("x", "drive x", "mm")):
            score = self._score.get(key) or {}
            window = (self._score.get("short") or {}).get(key)
            error = None if window is None else f"{cell(1e6 * window)} µm" if key == "u" else f"{cell(window)} N"
            table.add_row(
                title,
                _value(self._values.get(key), unit),
                _value(self._values.get(f"{key}_sim"), unit),
                _r(score.get("R")),
                _r(score.get("sliding_R")),
                cell(score.get("nrmse")) if key != "x" else "",
                (error or "–") if key != "x" else "",
            )
        return table


def _value(value: float | None, unit: str) -> str:
    return "" if value is None else f"{value:8.3f} {unit}"


def _r(value: float | None) -> str:
    return "" if value is None else f"{value:.5f}"
