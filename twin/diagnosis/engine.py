"""From recordings to a verdict: audit, calibrate, search, confirm on held-out windows, say what it means."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

import twin.causes
from stand.errors import InputError
from stand.recording import Recording
from stand.setup import System
from twin.causes._kind import Cause
from twin.diagnosis import clipped
from twin.diagnosis.audit import audit_all
from twin.diagnosis.composition import Composition
from twin.diagnosis.fit import FINE, Fitted, fit
from twin.diagnosis.following import following
from twin.diagnosis.found import Evidence, Step
from twin.diagnosis.hum import find
from twin.diagnosis.misfit import error, gained
from twin.diagnosis.problem import Problem
from twin.diagnosis.rivals import Standing, settle, tried
from twin.diagnosis.run import choose, prepare
from twin.diagnosis.search import Search, backward, calibrate, forward
from twin.diagnosis.tell import tell
from twin.diagnosis.unknown import look
from twin.diagnosis.verdict import Verdict
from twin.diagnosis.work import Here, Work
from twin.plugins import every

#: share by which a cause must lower the error on windows that were not fitted
CONFIRMED = 0.01
#: probability below which a cause, its rivals counted in, is not named
NAMED = 0.1
#: runs up to which each has all its windows, and the fewest that a run has beyond
CAMPAIGN, FEWEST = 15, 6
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class Options:
    """windows: per run, in all and in the search, fewer beyond CAMPAIGN runs. causes: names to consider, all where
    empty. work: who does the fits that don't hang on each other.
    """

    windows: int = 24
    searched: int = 10
    causes: tuple[str, ...] = ()
    work: Work = field(default_factory=Here)


def _silent(what: str, fraction: float) -> None:
    return None


def diagnose(
    recordings: Sequence[Recording],
    *,
    skipped: Sequence[dict[str, str]] = (),
    progress: Progress = _silent,
    options: Options = Options(),
) -> Verdict:
    """The verdict on one recording or a campaign of one rig.

    Raises InputError where no recording can be used, with the remedy. `skipped`: files that could not even be read.
    """
    progress("audit", 0.0)
    good, bad, notes = audit_all(recordings, skipped)
    good, lines = find(good)
    catalogue = known(good[0].setup.system, options.causes)
    considered = frozenset(c.name for c in catalogue)
    runs, limits = clipped.find([prepare(r) for r in good], considered)
    problem = Problem(runs, choose(runs, _each(options.windows, len(runs), FEWEST)))
    if len(problem.windows) < 4:
        remedy = "Record motion that leaves the fibre taut now and then, for longer"
        raise InputError("no stretch of motion from which a window could be started", where=good[0].name, remedy=remedy)
    progress("calibrating", 0.15)
    trained = problem.part(_searched(problem, _each(options.searched, len(runs), FEWEST // 2)))
    able = [c for c in catalogue if c.how != "line" and c.name not in {limit.cause for limit in limits}]
    base = calibrate(trained)
    search = Search(trained, base, base, options.work, ladder=[base])
    forward(search, able, progress)
    progress("checking", 0.75)
    backward(search)
    ranks = settle(search, able)
    if judge(search, problem.part(problem.windows.held)):
        ranks = settle(search, able)
    if doubt(search, ranks):
        ranks = settle(search, able)
    progress("looking beyond the catalogue", 0.82)
    beyond = look(search)
    if beyond is not None and beyond.learned:
        search.current = beyond.fitted
        search.ladder = [f for f in search.ladder if _part_of(f, beyond.fitted)] + [beyond.fitted]
        ranks = [r for r in ranks if r.name in beyond.fitted.model.names]
    elif beyond is not None and beyond.fitted is search.base:  # the catalogue's causes only stood in for it
        search.current, ranks, search.ladder = search.base, [], search.ladder[:1]
    progress("confirming on held-out windows", 0.85)
    named = set(search.current.model.names) | {limit.cause for limit in limits}
    if "end-stop" in considered and not named & {"end-stop", "dial-gauge-saturation"}:
        limits += clipped.stop(runs)
    for limit in limits:
        _add(search, limit, catalogue)
        ranks.append(Standing(limit.cause, {}, 0.98, (), {}))
    found = confirm(problem, search, ranks, notes)
    order = following(search, ranks)
    progress("writing the verdict", 0.95)
    verdict = tell(good, bad, search, found, catalogue, ranks, lines, limits, beyond, order)
    progress("done", 1.0)
    return verdict


def judge(search: Search, held: Problem) -> bool:
    """Take back causes that don't predict windows which were not fitted any better; whether one went.

    A base value is judged by its pull alone and stays.
    """
    gone = False
    while len(held.windows) >= 4 and search.current.model.causes:
        now = fixed(held, search.current)
        idle = []
        judged = [c for c in search.current.model.causes if c.base is None]
        for thinner in search.lacking(judged):
            gain = gained(held, fixed(held, thinner), now)
            if gain < CONFIRMED:
                idle.append((gain, thinner))
        if not idle:
            return gone
        _step_back(search, min(idle, key=lambda pair: pair[0])[1])
        gone = True
    return gone


def doubt(search: Search, ranks: Sequence[Standing]) -> bool:
    """Take back the causes that are hardly to be believed, the least first; whether one went."""
    weak = sorted((r for r in ranks if r.probability * (1 + len(r.alike)) < NAMED), key=lambda r: r.probability)
    for rank in weak:
        cause = next(c for c in search.current.model.causes if c.name == rank.name)
        _step_back(search, search.lacking([cause])[0])
    return bool(weak)


def _step_back(search: Search, thinner: Fitted) -> None:
    """Go on with fewer causes; rungs with others go."""
    search.current = thinner
    search.ladder = [f for f in search.ladder if _part_of(f, thinner)]
    if search.ladder[-1].model.causes != thinner.model.causes:
        search.ladder.append(thinner)


def _add(search: Search, limit: clipped.Clip, catalogue: Sequence[Cause]) -> None:
    """Puts a limit that was read off the records into the model; the windows have nothing beyond it."""
    cause = next(c for c in catalogue if c.name == limit.cause)
    current = search.current
    model = Composition(current.model.setups, (*current.model.causes, cause))
    z = model.put(current.model.carry(current.z, model), cause, {cause.parameters[0].name: limit.level})
    search.current = Fitted(model, z, current.starts, current.residual, current.cost)
    search.ladder.append(search.current)


def _part_of(fitted: Fitted, whole: Fitted) -> bool:
    return set(fitted.model.names) <= set(whole.model.names)


def known(system: System, only: Sequence[str] = ()) -> list[Cause]:
    """The catalogue for a rig, causes of one among several signals spread out."""
    found: list[Cause] = []
    for cause in every(twin.causes, Cause):
        found += [c for c in cause.variants or (cause,) if system in c.systems and (not only or cause.name in only)]
    return found


def _each(windows: int, runs: int, least: int) -> int:
    """How many windows each of many runs has: fewer beyond CAMPAIGN of them."""
    return min(windows, max(least, round(windows * min(1.0, CAMPAIGN / runs))))


def _searched(problem: Problem, per_run: int) -> np.ndarray:  # type: ignore[type-arg]
    """A share of the windows that are not held out, evenly."""
    keep = np.zeros(len(problem.windows), bool)
    for run in range(len(problem.runs)):
        mine = np.flatnonzero((problem.windows.run == run) & ~problem.windows.held)
        if len(mine):
            keep[mine[np.unique(np.linspace(0, len(mine) - 1, min(per_run, len(mine))).round().astype(int))]] = True
    return keep


def confirm(problem: Problem, search: Search, ranks: Sequence[Standing], notes: list[str]) -> Evidence:
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
    final = fit(problem, final.model, final.z, final.starts, iterations=10, tolerance=FINE)
    return Evidence(problem, nothing, calibrated, final, tuple(ladder), tried(search, ranks), tuple(notes))


def fixed(problem: Problem, fitted: Fitted, *, stated: bool = False) -> Fitted:
    """The fit's model on other windows, only their starts fitted; `stated`: with the setup's values as they are."""
    z = fitted.model.zero() if stated else fitted.z
    return fit(problem, fitted.model, z, iterations=2, fixed=np.ones(len(z), bool))


def _pair(problem: Problem, fitted: Fitted) -> tuple[float, float]:
    u, F = np.sqrt(error(problem, fitted.residual))
    return float(u), float(F)
