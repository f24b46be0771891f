"""A recording beside its models: the JSON that other programs read and the page that people read."""

from __future__ import annotations

import json
import re
from pathlib import Path

import h5py
import numpy as np
import pytest

import twin.models
from stand.errors import InputError
from stand.recording import Recording, read_recording
from stand.setup import System, nominal
from tests.twin.reference import sinusoid, trapezoid
from twin.compare import compare
from twin.compare.measured import release
from twin.model import FibreModel, Start
from twin.plugins import load
from twin.report import comparison_page
from twin.simulate import simulate

FORCE = load(twin.models, "force", FibreModel)


def recording(table: np.ndarray, seed: int = 0, **true: float) -> Recording:
    """A run of a stand that is the model but for `true`, in memory."""
    rng, time = np.random.default_rng(seed), np.arange(len(table)) / 2000.0
    run = simulate(nominal().with_values(**true), time, table[:, 0], FORCE)
    channels = {
        "drive_position": table[:, 0] + 1e-6 * rng.standard_normal(len(time)),
        "weight_position": run.u + 6e-6 * rng.standard_normal(len(time)),
        "fibre_force": run.F + 0.12 * rng.standard_normal(len(time)),
    }
    return Recording(None, nominal(), time, channels)


SNATCH = trapezoid(4.0, 0.02, 2.0, 6.0, phase=1.0)
TAUT = np.vstack((np.zeros((2000, 2)), sinusoid(3.0, 0.06, 0.5)))


def test_the_baseline_has_the_keys_of_the_verdict_and_nothing_undefined() -> None:
    made = compare(recording(SNATCH)).to_json()
    run = json.loads(json.dumps(made, allow_nan=False))["baseline"]["runs"][0]
    assert set(run) >= {"file", "slack_fraction", "weight_position", "fibre_force"}
    for channel in ("weight_position", "fibre_force"):
        assert set(run[channel]) >= {"R", "R_ceiling", "nrmse", "lag_s", "gain", "peak_error"}
    assert run["weight_position"]["R"] > 0.999
    assert 0.3 < run["slack_fraction"] < 0.8


def test_without_slack_the_ceiling_is_one_and_no_snatch_is_told() -> None:
    made = compare(recording(TAUT))
    assert made.measured.snatch is None
    assert made.measured.slack < 0.01
    assert made.ceiling_u > 0.9999999


def test_the_first_snatch_is_where_the_force_comes_back_after_slack() -> None:
    data = compare(recording(SNATCH)).measured
    at = round(data.snatch * 2000)
    assert data.F[at - 10 : at - 1].max() < 1.0
    assert data.F[at : at + 10].max() > 2.0


def test_a_wrong_damping_shows_in_short_windows() -> None:
    right, wrong = (compare(recording(SNATCH, fibre_damping=b)).baseline for b in (27.5, 60.0))
    assert wrong.short_F > 1.5 * right.short_F


def test_models_stand_side_by_side_and_identical_ones_score_alike() -> None:
    made = compare(recording(TAUT), ("force", "force-damping"))
    assert [run.name for run in made.runs] == ["force", "force-damping"]
    assert made.runs[0].score_u == made.runs[1].score_u


def test_an_unknown_model_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="no-such-model"):
        compare(recording(TAUT), ("no-such-model",))


def test_a_sample_that_is_no_number_is_placed() -> None:
    bad = recording(TAUT)
    bad.channels["fibre_force"][123] = np.nan
    with pytest.raises(InputError, match=r"fibre_force: 1 samples are not numbers, the first at 0\.0615 s"):
        compare(bad)


def test_a_foreign_file_with_data_and_setup_only_is_compared(tmp_path: Path) -> None:
    made = recording(SNATCH)
    with h5py.File(tmp_path / "foreign.h5", "w") as file:
        data, setup = file.create_group("entry/data"), file.create_group("entry/setup")
        for name, values, factor, unit in (
            ("time", made.time, 1e3, "ms"),
            ("drive_position", made.x, 1e3, "mm"),
            ("weight_position", made.u, 1e6, "um"),
            ("fibre_force", made.F, 1e-3, "kN"),
        ):
            data.create_dataset(name, data=values * factor).attrs["units"] = unit
        setup["system"] = "weight-fibre-pulley-drive"
        for name, value, unit in (("weight_mass", 3096.0, "g"), ("incline_angle", 30.0, "deg")):
            setup[name] = value
            setup[name].attrs["units"] = unit
    found = compare(read_recording(tmp_path / "foreign.h5"))
    assert pytest.approx(compare(made).baseline.score_u.R, abs=1e-6) == found.baseline.score_u.R
    assert any("nominal values are used" in note for note in found.notes)


def test_a_release_runs_free_from_the_moment_of_letting_go() -> None:
    setup = nominal(System.WF)
    time = np.arange(3000) / 2000.0
    fall = simulate(setup, time, None, FORCE, start=Start(u=0.01))
    u = np.concatenate((np.zeros(1000), 0.005 * (1 - np.cos(np.linspace(0, np.pi, 1000))), np.full(500, 0.01), fall.u))
    F = np.concatenate((np.full(1000, setup.rest_tension), np.zeros(1500), fall.F))
    rng = np.random.default_rng(0)
    noisy = {"weight_position": u + 6e-6 * rng.standard_normal(len(u)), "fibre_force": F}
    made = compare(Recording(None, setup, np.arange(len(u)) / 2000.0, noisy))
    assert abs(release(u, 5e-4) - 2500) < 12
    assert made.baseline.score_u.R > 0.99


def test_the_page_opens_offline_and_reads_in_sentences(tmp_path: Path) -> None:
    page = comparison_page(compare(recording(SNATCH), ("force", "force-both")), tmp_path / "page.html").read_text()
    own = re.sub(r"<script>/\*\*.*?</script>", "", page, flags=re.S)
    assert not re.search(r'(src|href)\s*=\s*"https?:', page[:20_000])
    assert "judge by the short windows" in own
    assert page.count('<figure class="chart">') == 4
    for heading in ("What this run says", "Deviation", "Phase plane", "Spectra", "Provenance"):
        assert f"<h2>{heading}</h2>" in page
