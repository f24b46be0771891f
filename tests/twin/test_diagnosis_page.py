"""The diagnosis's page says what the verdict says, and proves it with pictures."""

from __future__ import annotations

import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from twin.diagnosis.verdict import Verdict
from twin.report.diagnosis import diagnosis_page
from twin.report.diagnosis_words import headline

DRAG = {
    "name": "guide-viscous-drag", "probability": 0.97, "acts_on": "guide",
    "indistinguishable_from": ["pulley-bearing-drag"],
    "parameters": {"coefficient": {"value": 7.9, "std": 0.2, "units": "N*s/m"}}, "strength": 5.0, "evidence": ["drag"],
}  # fmt: skip


def _data(**more: Any) -> dict[str, Any]:
    return {
        "baseline": {"runs": [{"file": "run-1.h5"}], "skipped": [{"file": "run-9.h5", "why": "too short"}]},
        "calibration": {"weight_mass": {"value": 2.0, "std": 0.01, "units": "kg", "moved_sigma": -0.3}},
        "findings": [], "causes": [], "unknown": None, "model": None, "next_experiment": None, "notes": [],
        "not_found": [{"name": "end-stop", "smallest_visible": {"position": None}, "why": "no run reaches it"}],
        "gain": {"held_out": [], "prediction_error_ratio": 0.2, "prediction_error_noise_units": 1.1},
        "ladder": [{"name": "baseline", "error": (9.0, 8.0), "held_out": (9.5, float("nan"))}],
    } | more  # fmt: skip


def _evidence() -> Any:
    """Eight windows of a weight that swings, the error growing with its speed until drag is found."""
    random = np.random.default_rng(1)
    n, length, dt = 8, 184, 5e-4
    speed = np.sin(np.linspace(0, 40, n * length)).reshape(n, length)
    signals = np.stack([0.01 * speed, speed, 20 + speed, speed, 0.02 * speed], axis=-1)
    noise = random.normal(size=(n, length, 2))
    windows = SimpleNamespace(
        run=np.zeros(n, int), first=np.arange(n) * 300, data=noise, use=np.ones((n, length, 2), bool),
        held=np.arange(n) % 2 == 0, __len__=lambda: n,
    )  # fmt: skip
    windows = type("W", (SimpleNamespace,), {"__len__": lambda self: n})(**vars(windows))
    drive = SimpleNamespace(value=np.sin(np.arange(4000) * dt * 10))
    run = SimpleNamespace(x=drive, dt=dt, setup=SimpleNamespace(pulley_radius=0.05))
    problem = SimpleNamespace(
        runs=(run,), windows=windows, dt=dt, sigma=np.ones((n, 2)), simulate=lambda model, z, starts: (signals, None)
    )
    fitted = [SimpleNamespace(residual=noise + k * speed[..., None], model=None, z=0, starts=0) for k in (5, 0)]
    return SimpleNamespace(problem=problem, calibrated=fitted[0], final=fitted[1], rivals=())


def _figures(html: str) -> list[Any]:
    return [json.loads(t) for t in re.findall(r'<script type="application/json">(.*?)</script>', html)]


def test_a_cause_is_named_with_its_size_probability_and_rival(tmp_path: Path) -> None:
    verdict = Verdict(_data(causes=[DRAG], findings=["drag is too low"]), evidence=_evidence())
    html = diagnosis_page(verdict, tmp_path / "page.html").read_text()
    for words in (
        "guide-viscous-drag (coefficient 7.9 ± 0.2 N*s/m), probability 97%",
        "pulley-bearing-drag",
        "too short",
    ):
        assert words in html


def test_a_finding_comes_first_with_its_own_picture(tmp_path: Path) -> None:
    verdict = Verdict(_data(causes=[DRAG], findings=["drag is too low"]), evidence=_evidence())
    html = diagnosis_page(verdict, tmp_path / "page.html").read_text()
    figures = _figures(html)
    assert figures[0]["layout"]["xaxis"]["title"] == "weight speed in m/s"
    assert len(figures) == 8


def test_the_page_needs_nothing_from_a_network(tmp_path: Path) -> None:
    html = diagnosis_page(Verdict(_data()), tmp_path / "page.html").read_text()
    assert not re.search(r'<(script|link|img)[^>]+(src|href)="?http', html)


def test_a_clean_stand_is_told_so() -> None:
    assert headline(_data()).startswith("Nothing is wrong: calibration within the stated uncertainties")


def test_an_unknown_shows_its_shape_and_what_it_depends_on(tmp_path: Path) -> None:
    unknown = {
        "depends_on": ["weight_position"], "acts_on": "guide", "units": "N", "probability": 0.95, "gain": 0.4,
        "shape": {"x": [0.0, 0.01], "y": [1.0, 2.0], "std": [0.1, 0.1]},
    }  # fmt: skip
    html = diagnosis_page(Verdict(_data(unknown=unknown)), tmp_path / "page.html").read_text()
    assert "not in the catalogue acts on the guide and depends on weight position" in html
    assert any(trace.get("name") == "learned" for f in _figures(html) for trace in f["data"])
