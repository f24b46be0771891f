"""The diagnosis as a page: what is wrong, what causes it, the pictures that prove it, and what was gained."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any

from twin.diagnosis.verdict import Verdict
from twin.report import diagnosis_plots as plots
from twin.report import diagnosis_tables as tables
from twin.report.diagnosis_words import headline, proofs, sized
from twin.report.page import details, document, findings, number, paragraph, section, tiles

Json = Mapping[str, Any]


def diagnosis_page(verdict: Verdict, path: Path | str) -> Path:
    """Writes the page of `verdict` to `path` and returns the path; the file needs nothing else to open."""
    path = Path(path)
    path.write_text(page(verdict), encoding="utf-8")
    return path


def page(verdict: Verdict) -> str:
    """The page as HTML; what the verdict leaves empty is left out or said to be empty."""
    v = verdict.to_json()
    body = [
        section("The verdict", paragraph(headline(v), "lead"), findings(sized(v))),
        _tiles(v),
        _findings(verdict, v),
        section("What each step gains", plots.ladder(v), tables.ladder(v)),
        tables.rivals(verdict, v),
        tables.parameters(v),
        plots.unknown(v),
        tables.not_found(v),
        tables.next_experiment(v),
        tables.runs(v),
        tables.provenance(verdict, v),
    ]
    return document("Diagnosis", _subtitle(v), [part for part in body if part], "Opens offline.")


def _subtitle(v: Json) -> str:
    runs = [run for run in v["baseline"]["runs"] if run]
    files = ", ".join(Path(run["file"]).name for run in runs[:6])
    return f"{len(runs)} recording{'s' if len(runs) != 1 else ''}: {files}{' …' if len(runs) > 6 else ''}"


def _tiles(v: Json) -> str:
    gain, rungs = v["gain"], v.get("ladder") or []
    ratio, units = gain.get("prediction_error_ratio"), gain.get("prediction_error_noise_units")
    entries = []
    for cause in v["causes"]:
        entries.append((cause["name"], f"{cause['probability']:.0%}", f"strength {number(cause['strength'], 2)}", ""))
    if not v["causes"]:
        entries.append(("Causes found", "none", f"{len(v['not_found'])} tested", "good"))
    kind = "good" if units is not None and units < 1.3 else "warn"
    entries.append(("Held-out error", f"{number(units, 3)} ×", "the sensors' noise", kind))
    entries.append(("Of the calibrated baseline's", number(ratio, 2), f"ladder of {len(rungs)} steps", ""))
    return tiles(entries)


def _findings(verdict: Verdict, v: Json) -> str:
    """Each finding with the pictures that matter to it; the other pictures folded away."""
    e = verdict.evidence
    if e is None:
        return section("Findings", findings(v["findings"] or ["Nothing was found."]))
    pictures = plots.pictures(e)
    shown: set[str] = set()
    parts = []
    for sentence, keys in proofs(v):
        parts.append(f"<h3>{escape(sentence)}</h3>\n")
        fresh = [k for k in keys if k in pictures and k not in shown]
        shown.update(fresh)
        parts += [pictures[k] for k in fresh]
    rest = "".join(html for key, html in pictures.items() if key not in shown)
    parts.append(details("More pictures of what the simulation leaves", rest) if rest else "")
    return section("Findings, and the pictures that prove them", *parts)
