"""The battery's table: cause by cause, false alarms, sizes, coverage, gain, probabilities, time."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from statistics import median
from typing import Any, TypeVar

Result = dict[str, Any]
R = TypeVar("R")
LEVELS = (1.0, 2.0, 5.0, 10.0)


def wilson(hits: int, n: int, z: float = 1.96) -> tuple[float, float]:
    """Wilson's 95 % interval of a proportion (Wilson 1927)."""
    if n == 0:
        return 0.0, 1.0
    p, z2 = hits / n, z * z
    centre, half = p + z2 / (2 * n), z * math.sqrt(p * (1 - p) / n + z2 / (4 * n * n))
    return (centre - half) / (1 + z2 / n), (centre + half) / (1 + z2 / n)


def share(name: str, results: Sequence[R], hit: Callable[[R], bool]) -> str:
    """One line: how many, in per cent, with the interval."""
    hits, n = sum(map(hit, results)), len(results)
    if n == 0:
        return f"{name:58s}  none"
    low, high = wilson(hits, n)
    return f"{name:58s} {hits:4d}/{n:<4d} {100 * hits / n:5.1f} %  [{100 * low:.1f}, {100 * high:.1f}]"


def table(results: Sequence[Result]) -> str:
    """The whole report as text."""
    return "\n".join([*_causes(results), "", *_rates(results), "", *_numbers(results)])


def _of(results: Iterable[Result], kind: str) -> list[Result]:
    return [r for r in results if r["kind"] == kind]


def _causes(results: Sequence[Result]) -> list[str]:
    singles = _of(results, "single")
    lines = [f"{'cause':30s} stands found rival missed confused error  confused with"]
    for name in sorted({r["hidden"][0] for r in singles}):
        mine = [r for r in singles if r["hidden"][0] == name]
        n = Counter(r["outcome"] for r in mine)
        wrong = Counter(r["named"][0] if r["named"] else "unknown" for r in mine if r["outcome"] == "confused")
        said = ", ".join(f"{k} {v}" for k, v in wrong.most_common(3))
        counts = f"{n['found']:5d} {n['rival']:5d} {n['missed']:6d} {n['confused']:8d} {n['error']:5d}"
        lines.append(f"{name:30s} {len(mine):6d} {counts}  {said}")
    return lines


def _rates(results: Sequence[Result]) -> list[str]:
    good = [r for r in results if r["outcome"] != "error"]
    singles, lines = _of(good, "single"), []
    for k, low in enumerate(LEVELS):
        high = LEVELS[k + 1] if k + 1 < len(LEVELS) else math.inf
        at = [r for r in singles if low <= r["wanted"][0] < high]
        lines.append(share(f"strength {low:g} to {high:g}: right, or among three", at, _held))
    strong = [r for r in singles if r["wanted"][0] >= 5]
    lines += [
        share("strength 5 and more: right, or among three", strong, _held),
        share("strength 5 and more: right name first", strong, lambda r: r["outcome"] == "found"),
        share("clean stands: something named", _of(good, "clean"), lambda r: r["outcome"] == "alarm"),
        share("in the catalogue: unknown is null", [r for r in good if r["kind"] != "outside"], _null),
        share("two effects: both named", _of(good, "double"), _held),
        share("outside the catalogue: unknown", _of(good, "outside"), lambda r: r["unknown"] is not None),
        share("outside the catalogue: right dependence first", _of(good, "outside"), _right_dependence),
        share("stands that ended in an error", results, lambda r: r["outcome"] == "error"),
    ]
    return lines


def _held(result: Result) -> bool:
    return result["outcome"] in ("found", "rival")


def _null(result: Result) -> bool:
    return result["unknown"] is None


def _right_dependence(result: Result) -> bool:
    return bool(result["unknown"]) and result["unknown"][0] in result["depends_on"]


def _numbers(results: Sequence[Result]) -> list[str]:
    good = [r for r in results if r["outcome"] != "error"]
    strong = [r for r in _of(good, "single") if r["wanted"][0] >= 5]
    main = [r["size"][0] for r in strong if r["size"] and r["size"][0]["std"]]
    within = [s for s in main if abs(s["value"] - s["true"]) <= 0.1 * abs(s["true"])]
    covered = [s for s in main if abs(s["value"] - s["true"]) <= s["std"]]
    lines = [
        share("size within 10 %", main, lambda s: s in within),
        share("within one stated sigma", main, lambda s: s in covered),
    ]
    if main:
        relative = median(s["std"] / abs(s["true"]) for s in main if s["true"])
        lines.append(f"{'median stated std, per cent of the size':58s} {100 * relative:.1f} %")
    ratios = [r["ratio"] for r in strong if r["ratio"] is not None]
    if ratios:
        lines.append(f"{'median held-out prediction error ratio':58s} {median(ratios):.3f}")
    told = [r["noise_units"] for r in strong if r["noise_units"] is not None]
    if told:
        lines.append(f"{'median held-out error, the true model leaving about 1':58s} {median(told):.3f}")
        lines.append(share("held-out error at most 1.3", told, lambda n: n <= 1.3))
    lines += _reliability(good)
    if good:
        times = sorted(r["seconds"] for r in good)
        lines.append(f"{'seconds a campaign: median, longest':58s} {median(times):.1f}, {times[-1]:.1f}")
    return lines


def _reliability(results: Sequence[Result]) -> list[str]:
    """Stated probabilities of the named causes against how often they were hidden, and the expected calibration
    error.
    """
    said = [(p, name in r["hidden"]) for r in results for p, name in zip(r["probability"], r["named"], strict=True)]
    if not said:
        return []
    lines, error = ["probability stated   how often right"], 0.0
    for low in (0.0, 0.5, 0.7, 0.9, 0.97):
        high = {0.0: 0.5, 0.5: 0.7, 0.7: 0.9, 0.9: 0.97, 0.97: 1.01}[low]
        inside = [(p, r) for p, r in said if low <= p < high]
        if inside:
            stated = sum(p for p, _ in inside) / len(inside)
            seen = sum(r for _, r in inside) / len(inside)
            error += abs(stated - seen) * len(inside) / len(said)
            lines.append(f"  {stated:8.3f}            {seen:8.3f}   ({len(inside)} causes)")
    return [*lines, f"{'expected calibration error':58s} {error:.3f} over {len(said)} causes"]
