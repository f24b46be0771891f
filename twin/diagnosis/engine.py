"""From recordings to a verdict: audit, calibrate, search, confirm on held-out windows, say what it means."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

import twin.causes
from stand.errors import InputError
from stand.recording import Recording
from twin.causes._kind import Cause
from twin.diagnosis.audit import audit_all
from twin.diagnosis.fit import Fitted, fit
from twin.diagnosis.found import Evidence, Step
from twin.diagnosis.problem import Problem
from twin.diagnosis.run import choose, prepare
from twin.diagnosis.search import Search, backward, calibrate, error, forward
from twin.diagnosis.tell import tell
from twin.diagnosis.verdict import Verdict
from twin.plugins import every

Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class Options:
    """windows: per run, in all and in the search. causes: names to consider, all where empty."""

    windows: int = 24
    searched: int = 10
    causes: tuple[str, ...] = ()


def _silent(what: str, fraction: float) -> None:
    return None


def diagnose(
    recordings: Sequence[Recording],
    *,
    skipped: Sequence[dict[str, str]] = (),
    progress: Progress = _silent,
    options: Options = Options(),  # noqa: B008 - frozen
) -> Verdict:
    """The verdict on one recording or a campaign of one rig.

    Raises InputError where no recording can be used, with the remedy. `skipped`: files that could not even be read.
    """
    progress("audit", 0.0)
    good, bad, notes = audit_all(recordings, skipped)
    runs = tuple(prepare(r) for r in good)
    problem = Problem(runs, choose(runs, options.windows))
    if len(problem.windows) < 4:
        remedy = "Record motion that leaves the fibre taut now and then, for longer"
        raise InputError("no stretch of motion from which a window could be started", where=good[0].name, remedy=remedy)
    catalogue = [c for c in every(twin.causes, Cause) if runs[0].setup.system in c.systems]
    if options.causes:
        catalogue = [c for c in catalogue if c.name in options.causes]
    progress("calibrating", 0.15)
    trained = problem.part(_searched(problem, options.searched))
    search = forward(trained, calibrate(trained), catalogue, progress)
    progress("checking", 0.75)
    backward(search)
    progress("confirming on held-out windows", 0.85)
    found = confirm(problem, search, notes)
    progress("writing the verdict", 0.95)
    verdict = tell(good, bad, search, found, catalogue)
    progress("done", 1.0)
    return verdict


def _searched(problem: Problem, per_run: int) -> np.ndarray:  # type: ignore[type-arg]
    """A share of the windows that are not held out, evenly."""
    keep = np.zeros(len(problem.windows), bool)
    for run in range(len(problem.runs)):
        mine = np.flatnonzero((problem.windows.run == run) & ~problem.windows.held)
        if len(mine):
            keep[mine[np.unique(np.linspace(0, len(mine) - 1, min(per_run, len(mine))).round().astype(int))]] = True
    return keep


def confirm(problem: Problem, search: Search, notes: list[str]) -> Evidence:
    """Baseline, calibrated and final fits over all windows, and every rung's error on windows never fitted."""
    held = problem.part(problem.windows.held) if problem.windows.held.any() else problem
    ladder = []
    nothing = fixed(problem, search.base, stated=True)
    rungs = [("baseline", search.base, True), ("calibrated", search.base, False)]
    rungs += [(f"+ {f.model.causes[-1].name}", f, False) for f in search.ladder[1:]]
    if search.ladder[-1] is not search.current:
        rungs.append(("without what was needless", search.current, False))
    for name, fitted, stated in rungs:
        unseen = fixed(held, fitted, stated=stated)
        seen = nothing if stated else fitted
        where = problem if stated else search.problem
        ladder.append(Step(name, _pair(where, seen), _pair(held, unseen)))
    calibrated = fixed(problem, search.base)
    final = fixed(problem, search.current)
    final = fit(problem, final.model, final.z, final.starts, iterations=4)
    return Evidence(problem, nothing, calibrated, final, tuple(ladder), (), tuple(notes))


def fixed(problem: Problem, fitted: Fitted, *, stated: bool = False) -> Fitted:
    """The fit's model on other windows, only their starts fitted; `stated`: with the setup's values as they are."""
    z = fitted.model.zero() if stated else fitted.z
    return fit(problem, fitted.model, z, iterations=3, fixed=np.ones(len(z), bool))


def _pair(problem: Problem, fitted: Fitted) -> tuple[float, float]:
    u, F = np.sqrt(error(problem, fitted.residual))
    return float(u), float(F)
