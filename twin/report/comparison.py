"""The page that stands beside a recording after each run."""

from __future__ import annotations

from html import escape
from pathlib import Path

from stand.excitation.spec import Shape
from twin.compare.comparison import Comparison, ModelRun
from twin.report import plots
from twin.report.page import (
    Cell,
    details,
    document,
    findings,
    number,
    paragraph,
    section,
    swatch,
    table,
    tiles,
)
from twin.report.words import grade, sentences


def comparison_page(comparison: Comparison, path: Path | str) -> Path:
    """Writes the page of `comparison` to `path` and returns the path; the file needs nothing else to open."""
    path = Path(path)
    path.write_text(page(comparison), encoding="utf-8")
    return path


def page(c: Comparison) -> str:
    """The page as HTML."""
    body = [
        _tiles(c),
        section("What this run says", findings(sentences(c))),
        section("Measured and simulated", plots.histories(c)),
        section("Scores", _scores(c), _explained(c)),
        section("Deviation", plots.deviations(c)),
        section("Phase plane", plots.phase_plane(c)),
        section("Spectra", plots.spectra(c)),
        section("Provenance", _origin(c), details("The setup, as its operator states it", _setup(c))),
    ]
    made = c.provenance.get("compared", "")
    return document(f"{c.name}: measured and simulated", _subtitle(c), body, f"Made {escape(made)}. Opens offline.")


def _subtitle(c: Comparison) -> str:
    parts = [str(c.measured.setup.system).replace("-", " "), f"{c.measured.setup.mass:.3f} kg"]
    e = c.excitation
    if e is not None and e.shape is Shape.RELEASE:
        parts.append(f"released from {e.drop_height * 1e3:.1f} mm")
    elif e is not None:
        parts.append(f"{e.shape}, {e.frequency:g} Hz, {e.amplitude * 1e3:g} mm")
    parts.append(f"{c.measured.time[-1] - c.measured.time[0]:.1f} s")
    return " · ".join(parts)


def _tiles(c: Comparison) -> str:
    run = c.baseline
    noise_u, noise_F = c.measured.noise
    return tiles(
        [
            (
                "R of the weight's position",
                f"{run.score_u.R:.4f}",
                f"ceiling {c.ceiling_u:.4f}",
                grade(run.score_u.R, c.ceiling_u),
            ),
            (
                "R of the fibre force",
                f"{run.score_F.R:.3f}",
                f"ceiling {c.ceiling_F:.3f}",
                grade(run.score_F.R, c.ceiling_F),
            ),
            (
                "u over short windows",
                number(run.short_u * 1e6, 3, "µm"),
                f"{number(run.short_u / noise_u, 2)} times the noise",
                "",
            ),
            (
                "F over short windows",
                number(run.short_F, 3, "N"),
                f"{number(run.short_F / noise_F, 2)} times the noise",
                "",
            ),
            ("Slack", f"{c.measured.slack:.1%}", _snatch(c), ""),
        ]
    )


def _snatch(c: Comparison) -> str:
    return "the fibre stays taut" if c.measured.snatch is None else f"first catch at {c.measured.snatch:.2f} s"


def _scores(c: Comparison) -> str:
    header = ("Model", "R", "ceiling", "NRMSE", "lag, ms", "gain", "peak error", "peak, simulated", "short windows")
    u = [_row(c, i, run, "u") for i, run in enumerate(c.runs)]
    F = [_row(c, i, run, "F") for i, run in enumerate(c.runs)]
    made = table(header, u, "Weight position u; errors in mm") + table(header, F, "Fibre force F; errors in N")
    cost = table(
        ("Model", "source", "slack", "windows", "computing time"),
        [(r.name, r.source, f"{r.slack:.1%}", str(r.windows), number(r.cost, 3, "s")) for r in c.runs],
        text=2,
    )
    failed = findings(f"{name} could not be run: {why}" for name, why in c.failed) if c.failed else ""
    return made + cost + failed


def _row(c: Comparison, index: int, run: ModelRun, channel: str) -> list[str | Cell]:
    s, unit = (run.score_u, 1e3) if channel == "u" else (run.score_F, 1.0)
    ceiling = c.ceiling_u if channel == "u" else c.ceiling_F
    short = run.short_u if channel == "u" else run.short_F
    best = min((r.short_u if channel == "u" else r.short_F) for r in c.runs)
    return [
        swatch(plots.role(index), run.title),
        number(s.R, 5),
        number(ceiling, 5),
        f"{s.nrmse:.2%}",
        number(s.lag * 1e3, 3),
        number(s.gain, 4),
        number(s.peak_error * unit, 4),
        number(s.peak_simulated * unit, 4),
        Cell(number(short * unit, 3), "best" if len(c.runs) > 1 and short == best else ""),
    ]


def _explained(c: Comparison) -> str:
    passed = c.baseline.passed_over
    return paragraph(
        "R is Pearson's coefficient: blind to gain and offset, very sensitive to lag. The ceiling is the R between "
        "runs of one model whose starts differ by the sensors' noise. Lag above 0: the simulation is late. Gain is the "
        "slope of simulated on measured. Short windows restart the model from the measured state in each tenth of a "
        f"second and take the rms error over 0.1 s; {passed} tenths were passed over because the fibre was slack or "
        "had just caught, so that the pulley could not be seen.",
        "caption",
    )


def _origin(c: Comparison) -> str:
    p = c.provenance
    software = ", ".join(f"{name} {version}" for name, version in p.get("software", {}).items())
    rows: list[tuple[str | Cell, ...]] = [
        ("Recording", _code(c.name)),
        ("SHA-256", _code(p.get("sha256") or "–")),
        ("Samples", f"{p.get('samples', 0)} at {p.get('rate_hz', 0.0):.0f} Hz"),
        ("Noise at rest (one sigma)", f"u {c.measured.noise[0] * 1e6:.1f} µm, F {c.measured.noise[1]:.3f} N"),
        ("Software", software),
    ]
    return table(("", ""), rows, text=2)


def _code(text: str) -> Cell:
    return Cell(f"<code>{escape(text)}</code>", "text")


def _setup(c: Comparison) -> str:
    rows = []
    for name, entry in c.provenance.get("setup", {}).items():
        sigma = f"{entry['uncertainty']:.3g}" if "uncertainty" in entry else ""
        stated = "" if entry.get("stated", True) or not sigma else " (default)"
        value = entry["value"] if isinstance(entry["value"], str) else f"{entry['value']:.6g}"
        rows.append((name.replace("_", " "), value, entry.get("units", ""), sigma + stated))
    return table(("quantity", "value", "unit", "one sigma"), rows)
