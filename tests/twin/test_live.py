"""The twin beside a run: what it says, what it keeps, what it admits."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import twin.models
from stand.errors import InputError
from stand.recording import Recording, write_recording
from stand.setup import System, nominal
from tests.twin.reference import trapezoid
from twin.live import LiveScore, LiveTwin, read_live, store_live
from twin.live.lag import StreamLag
from twin.model import FibreModel
from twin.plugins import load
from twin.score import best_lag, pearson
from twin.simulate import simulate

FORCE = load(twin.models, "force", FibreModel)


def stand(seconds: float = 3.0, seed: int = 0) -> dict[str, np.ndarray]:
    """A run of a stand that is the model, seen through sensors with noise and zeros of their own."""
    rng, table = np.random.default_rng(seed), trapezoid(seconds, 0.02, 2.0, 6.0, phase=1.0)
    time = np.arange(len(table)) / 2000.0
    true = simulate(nominal(), time, table[:, 0], FORCE)
    return {
        "time": time,
        "x": table[:, 0] + 0.03 + 1e-6 * rng.standard_normal(len(time)),
        "u": true.u - 0.1 + 6e-6 * rng.standard_normal(len(time)),
        "F": true.F + 0.12 * rng.standard_normal(len(time)),
    }


def stream(twin: LiveTwin, run: dict[str, np.ndarray], block: int = 40, lost: range = range(0)) -> list[LiveScore]:
    scores = []
    for i in range(0, len(run["time"]), block):
        if i not in lost:
            part = slice(i, i + block)
            scores.append(twin.push(run["time"][part], run["x"][part], run["u"][part], run["F"][part]))
    return [*scores, twin.finish()]


def test_a_stand_that_is_the_model_scores_near_one_and_short_windows_come_near_the_noise() -> None:
    last = stream(LiveTwin(nominal(), FORCE), stand())[-1]
    assert last.u.R > 0.9999
    assert last.F.R > 0.99
    assert abs(last.u.lag) < 1e-4
    assert last.u.short_error < 60e-6
    assert last.F.short_error < 1.0
    assert last.short_windows + last.passed_over >= 25
    assert last.dropped == 0


@pytest.mark.parametrize("late", [0, 7, -31])
def test_the_lag_summed_block_by_block_is_the_lag_of_the_whole_run(late: int) -> None:
    run = stand(6.0)
    measured, simulated = run["F"][200:-200], np.roll(run["F"], late)[200:-200]
    lag = StreamLag(0.0005)
    for i in range(0, len(measured), 40):
        lag.push(measured[i : i + 40], simulated[i : i + 40])
    assert lag.lag == pytest.approx(late * 0.0005, abs=2e-5)
    assert lag.lag == pytest.approx(best_lag(measured, simulated, 0.0005), abs=5e-6)


def test_block_size_changes_no_bit_of_what_is_simulated() -> None:
    made = []
    for block in (20, 333):
        twin = LiveTwin(nominal(), FORCE)
        stream(twin, stand(), block)
        made.append(twin.samples())
    assert np.array_equal(made[0]["simulated_u"], made[1]["simulated_u"])
    assert np.array_equal(made[0]["simulated_F"], made[1]["simulated_F"])
    assert len(made[0]["time"]) == len(made[1]["time"]) == 6001


def test_what_the_tap_dropped_is_counted_bridged_and_not_scored() -> None:
    run, twin = stand(), LiveTwin(nominal(), FORCE)
    last = stream(twin, run, lost=range(3000, 3100))[-1]
    assert last.dropped == 120
    assert last.samples == len(run["time"]) - 120
    assert last.notes == ("120 samples never reached the twin",)
    assert last.u.R > 0.99


def test_blocks_out_of_order_are_refused() -> None:
    run, twin = stand(1.5), LiveTwin(nominal(), FORCE)
    stream(twin, run)
    with pytest.raises(InputError, match="time goes back"):
        twin.push(*(run[name][:20] for name in ("time", "x", "u", "F")))


def test_a_rig_without_a_drive_has_no_live_twin() -> None:
    with pytest.raises(InputError, match="no live twin without a drive"):
        LiveTwin(nominal(System.WF), FORCE)


def test_the_load_is_told_and_a_twin_that_falls_behind_says_so() -> None:
    now = iter(np.arange(0.0, 1e4, 0.05))
    slow = LiveTwin(nominal(), FORCE, now=lambda: float(next(now)))
    assert "falls behind" in stream(slow, stand(1.5))[-1].notes[0]


def test_R_recomputed_from_the_stored_samples_is_the_R_that_was_shown(tmp_path: Path) -> None:
    run, twin = stand(), LiveTwin(nominal(), FORCE)
    stream(twin, run)
    channels = {"drive_position": run["x"], "weight_position": run["u"], "fibre_force": run["F"]}
    path = write_recording(Recording(None, nominal(), run["time"], channels), tmp_path / "run.h5")
    store_live(path, twin)
    kept, shown = read_live(path), twin.finish()
    assert len(kept["time"]) == len(run["time"])
    assert pearson(kept["u"], kept["simulated_u"]) == pytest.approx(shown.u.R, abs=1e-9)
    assert pearson(kept["F"], kept["simulated_F"]) == pytest.approx(shown.F.R, abs=1e-9)
