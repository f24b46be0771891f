"""The diagnosis's tables."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from typing import Any

from twin.diagnosis.verdict import Verdict
from twin.report.page import Cell, details, findings, number, paragraph, section, table

Json = Mapping[str, Any]


EXCITATION = {"frequency": "Hz", "amplitude": "m, peak to peak", "ramp": "s", "added_mass": "kg"}


def ladder(v: Json) -> str:
    """Steps with errors in noise units."""
    rows = [
        (r["name"], *(number(r[key][c], 3) for c in range(2) for key in ("error", "held_out")))
        for r in v.get("ladder") or []
    ]
    return table(("Step", "u, fitted", "u, held out", "F, fitted", "F, held out"), rows, "Times the sensors' noise")


def rivals(verdict: Verdict, v: Json) -> str:
    """What else was refitted, and how far behind it is."""
    tried = list(verdict.evidence.rivals) if verdict.evidence is not None else []
    alike = [
        f"{c['name']} cannot be told from {', '.join(c['indistinguishable_from'])}"
        for c in v["causes"]
        if c["indistinguishable_from"]
    ]
    if not tried and not alike:
        return ""
    rows = [
        (
            " + ".join(r.causes) or "calibration alone",
            number(r.error[0], 3),
            number(r.error[1], 3),
            f"{r.probability:.1%}",
            _sizes(r.parameters),
        )
        for r in tried
    ]
    body = table(("Causes", "error in u", "error in F", "probability", "parameters (SI)"), rows) if rows else ""
    return section("Rivals", findings(alike) if alike else "", body)


def _sizes(found: Mapping[str, Mapping[str, float]]) -> str:
    return ", ".join(f"{n.replace('_', ' ')} {number(x, 4)}" for values in found.values() for n, x in values.items())


def parameters(v: Json) -> str:
    """Causes' parameters and calibrated values with their intervals."""
    causes = [
        (c["name"], n.replace("_", " "), number(p["value"], 5), f"± {number(p['std'], 2)}", p["units"])
        for c in v["causes"]
        for n, p in c["parameters"].items()
    ]
    base = [
        (n.replace("_", " "), number(p["value"], 6), f"± {number(p['std'], 2)}", p["units"], _moved(p["moved_sigma"]))
        for n, p in v["calibration"].items()
    ]
    found = table(("Cause", "parameter", "value", "one sigma", "unit"), causes, text=2) if causes else ""
    header = ("Calibrated value", "value", "one sigma", "unit", "moved by, stated sigmas")
    return section("Parameters", found, table(header, base) if base else paragraph("Nothing was calibrated."))


def _moved(sigmas: float | None) -> Cell:
    if sigmas is None:
        return Cell("–")
    return Cell(f"{sigmas:+.2f}".replace("-", "−"), "bad" if abs(sigmas) > 3 else "warn" if abs(sigmas) > 2 else "")


def not_found(v: Json) -> str:
    """What was tested, and how small it would have been seen."""
    rows = []
    for n in v["not_found"]:
        name, smallest = next(iter(n["smallest_visible"].items()), ("", None))
        unit = n.get("units", "")
        rows.append((n["name"], name.replace("_", " "), number(smallest, 2, "" if unit == "1" else unit), n["why"]))
    if not rows:
        return ""
    header = ("Cause", "parameter", "smallest size that would show", "why it is not named")
    return section("Tested and not found", details(f"{len(rows)} causes", table(header, rows, text=2)))


def next_experiment(v: Json) -> str:
    """The run that would tell most."""
    e = v.get("next_experiment")
    if not e:
        return ""
    x = e["excitation"]
    rows = [(name.replace("_", " "), str(value), EXCITATION.get(name, "")) for name, value in x.items()]
    between = f"It separates {', '.join(e['separates'])}. " if e.get("separates") else ""
    return section("The next experiment", paragraph(f"{between}{e['why']}"), table(("Excitation", "", "unit"), rows))


def runs(v: Json) -> str:
    """Whole-run scores of the baseline, and what was skipped."""
    rows = []
    for r in v["baseline"]["runs"]:
        if not r:
            continue
        cells = [r["file"], "–" if r.get("slack_fraction") is None else f"{r['slack_fraction']:.1%}"]
        for channel in ("weight_position", "fibre_force"):
            score = r.get(channel) or {}
            cells += [number(score.get("R"), 4), number(score.get("R_ceiling"), 4), number(score.get("nrmse"), 3)]
        rows.append(cells)
    header = ("Recording", "slack", "R of u", "ceiling", "NRMSE of u", "R of F", "ceiling", "NRMSE of F")
    skipped = findings(f"{s['file']} was skipped: {s['why']}" for s in v["baseline"]["skipped"])
    words = "Whole-run scores of the uncalibrated baseline; after a snatch they measure chaos and don't judge."
    return section("The recordings", table(header, rows), paragraph(words, "caption"), skipped)


def provenance(verdict: Verdict, v: Json) -> str:
    """Notes, data used, the model's file."""
    notes = findings(v.get("notes") or [])
    where = v.get("model") or ("below" if verdict.model else "none: nothing to add")
    rows: list[tuple[str | Cell, ...]] = [("Extended model", where)]
    e = verdict.evidence
    if e is not None:
        w, noise = e.problem.windows, e.problem.sigma
        held = int(w.held.sum())
        rows.append(("Short windows", f"{len(w)}, of which {held} held out, {w.data.shape[1]} samples each"))
        rows.append(("Noise (one sigma)", f"u {noise[:, 0].mean() * 1e6:.2g} µm, F {noise[:, 1].mean():.2g} N"))
    model = (
        details("The extended model (TOML)", f"<pre><code>{escape(verdict.model)}</code></pre>")
        if verdict.model
        else ""
    )
    return section("Notes and provenance", notes, table(("", ""), rows, text=2), model)
