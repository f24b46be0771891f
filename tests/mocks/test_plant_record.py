"""Recordings of the simulated stand, read with plain h5py as anyone would."""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import numpy as np
import pytest

from mocks.plant.motion import SITUATIONS, Motion
from mocks.plant.operator import BOUND, draw_stand
from mocks.plant.rig import linear_drive, weight_fibre
from mocks.record import Noise, main_record, parse_hidden, record

UNITS = {
    "weight_mass": "kg", "added_mass": "kg", "incline_angle": "deg", "gravity": "m/s^2", "fibre_length": "m",
    "fibre_mass": "kg", "weight_strand_length": "m", "drive_strand_length": "m", "pulley_radius": "m",
    "pulley_inertia": "kg*m^2", "wrap_angle": "deg", "fibre_stiffness": "N/m", "fibre_damping": "N*s/m",
    "guide_friction": "N", "guide_friction_velocity": "m/s",
}  # fmt: skip
HIDDEN = {"guide-viscous-drag": {"coefficient": 8.0}}


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("runs") / "run.h5"
    return record(draw_stand(3), SITUATIONS["2"], path=file, seconds=4.0, seed=3, hidden=HIDDEN)


def test_it_is_laid_out_as_recordings_are(path: Path) -> None:
    with h5py.File(path) as file:
        entry = file["entry"]
        assert (file.attrs["NX_class"], entry.attrs["NX_class"]) == ("NXroot", "NXentry")
        assert entry["definition"][()].decode() == "weight-fibre-stand"
        data = entry["data"]
        assert data.attrs["signal"] == "weight_position"
        for name, unit in {"drive_position": "m", "weight_position": "m", "fibre_force": "N"}.items():
            assert data[name].shape == data["time"].shape
            assert data[name].attrs["units"] == unit
            assert data[name].attrs["uncertainty"] > 0
        assert np.allclose(np.diff(data["time"]), 1 / 2000)
        assert len(data["time"]) == 8000
        assert {name: entry["setup"][name].attrs["units"] for name in UNITS} == UNITS
        assert entry["excitation/shape"][()] == b"trapezoidal"
        assert entry["excitation/cycles"][()] == 2
        assert bool(entry["events"].attrs["complete"])


def test_it_rests_a_second_before_and_after_the_motion(path: Path) -> None:
    with h5py.File(path) as file:
        data = file["entry/data"]
        for name, noise in (("drive_position", 5e-6), ("weight_position", 6e-6), ("fibre_force", 0.12)):
            rest = data[name][:1980]
            assert rest.std() == pytest.approx(noise, rel=0.1)
            assert rest.mean() == pytest.approx(15.19 if "force" in name else 0.0, abs=0.5 if "force" in name else 1e-6)
        assert np.abs(data["drive_position"][-1800:]).max() < 4e-5
        assert data["drive_position"][:].max() == pytest.approx(0.030, abs=1e-4)


def test_the_truth_stands_beside_the_file_and_nowhere_in_it(path: Path) -> None:
    truth = json.loads(path.with_suffix(".truth.json").read_text())
    assert [cause["name"] for cause in truth["hidden"]] == ["guide-viscous-drag"]
    assert truth["hidden"][0]["parameters"] == {"coefficient": {"value": 8.0, "units": "N*s/m"}}
    assert b"viscous" not in path.read_bytes()
    with h5py.File(path) as file:
        believed = file["entry/setup/fibre_stiffness"][()]
    assert believed == truth["believed_setup"]["fibre_stiffness"] != truth["true_setup"]["fibre_stiffness"]


def test_the_operator_is_off_within_two_of_the_stated_sigmas() -> None:
    shares = []
    for seed in range(40):
        stand = draw_stand(seed)
        off = [abs(getattr(stand.true, n) - getattr(stand.believed, n)) / s for n, s in stand.uncertainty.items() if s]
        shares += off
        assert max(off) <= BOUND
    assert 0.6 < np.mean(np.square(shares)) < 1.0


def test_a_difference_is_one_from_what_the_operator_believes(tmp_path: Path) -> None:
    hidden = {"weight-mass": {"difference": 0.2}}
    stand = draw_stand(5)
    path = record(stand, SITUATIONS["2"], path=tmp_path / "m.h5", seconds=3.0, seed=1, hidden=hidden)
    truth = json.loads(path.with_suffix(".truth.json").read_text())
    assert truth["true_setup"]["weight_mass"] == truth["believed_setup"]["weight_mass"]
    with h5py.File(path) as file:
        rest = file["entry/data/fibre_force"][:1900].mean()
    true = truth["true_setup"]
    assert rest == pytest.approx((3.096 + 0.2) * true["gravity"] * np.sin(true["incline_angle"]), abs=0.02)


def test_the_same_seed_gives_the_same_numbers_and_another_other_noise(tmp_path: Path) -> None:
    stand, motion = draw_stand(1), Motion("trapezoidal", 2.0, 0.010, 0.2)

    def numbers(name: str, seed: int) -> np.ndarray:
        with h5py.File(record(stand, motion, path=tmp_path / name, seconds=3.0, seed=seed)) as file:
            return file["entry/data/weight_position"][:]

    assert np.array_equal(numbers("a.h5", 1), numbers("b.h5", 1))
    assert not np.array_equal(numbers("a.h5", 1), numbers("c.h5", 2))


def test_a_clock_that_runs_fast_dates_things_late(tmp_path: Path) -> None:
    stand, motion, quiet = draw_stand(1), SITUATIONS["2"], Noise(0, 0, 0, 0, 0, 0)

    def force(**hidden: dict) -> np.ndarray:
        effects = {name.replace("_", "-"): values for name, values in hidden.items()}
        file = record(stand, motion, path=tmp_path / "c.h5", seconds=4.0, hidden=effects, noise=quiet)
        with h5py.File(file) as read:
            return read["entry/data/fibre_force"][:]

    plain, fast = force(), force(clock_drift={"rate": 1e-3, "instrument": "force_gauge"})
    time = np.arange(len(plain)) / 2000.0
    expected = np.interp((time + 5e-4) / 1.001 - 5e-4, time, plain)
    assert np.abs(fast - plain).max() > 1.0
    assert np.percentile(np.abs(fast - expected), 99) < 0.02


def test_a_released_weight_hangs_where_it_hung(tmp_path: Path) -> None:
    motion = Motion("release", drop_height=0.010)
    path = record(draw_stand(1, weight_fibre(45.0), errors=0.0), motion, path=tmp_path / "wf.h5", seconds=6.0)
    with h5py.File(path) as file:
        entry = file["entry"]
        assert "drive_position" not in entry["data"]
        assert "pulley_radius" not in entry["setup"]
        assert entry["excitation/drop_height"][()] == 0.010
        u, force = entry["data/weight_position"][:], entry["data/fibre_force"][:]
    assert u[3900:3990].mean() == pytest.approx(0.010, abs=1e-5)
    assert np.abs(force[3500:3990].mean()) < 0.05
    assert u[4000:].min() < -5e-4
    assert force[-1000:].mean() == pytest.approx(3.096 * 9.81 * np.sin(np.pi / 4), abs=0.05)


def test_an_axis_moves_as_its_force_says(tmp_path: Path) -> None:
    quiet = Noise(0, 0, 0, 0, 0, 0)
    stand = draw_stand(1, linear_drive(12.0), errors=0.0)
    hidden = {"guide-viscous-drag": {"coefficient": 20.0}}
    path = record(stand, Motion("trapezoidal"), path=tmp_path / "l.h5", seconds=6.0, hidden=hidden, noise=quiet)
    with h5py.File(path) as file:
        assert set(file["entry/setup"]) == {"system", "moving_mass"}
        x, force = file["entry/data/drive_position"][:], file["entry/data/drive_force"][:]
    v = np.gradient(x, 1 / 2000)
    impulse = np.cumsum(force) / 2000
    assert np.allclose(12.0 * v + 20.0 * (x - x[0]), impulse, atol=0.03)
    assert np.ptp(impulse) > 2.0


def test_the_command_line_writes_runs_and_names_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    out = tmp_path / "x.h5"
    assert main_record(["--out", str(out), "--situation", "gentle", "--seconds", "3", "--hide", "drive-backlash"]) == 0
    assert out.exists()
    with pytest.raises(SystemExit) as ended:
        main_record(["--out", str(out), "--hide", "no-such-thing"])
    assert ended.value.code == 2
    assert "no-such-thing" in capsys.readouterr().err


def test_hidden_effects_are_read_from_text() -> None:
    assert parse_hidden(["mains-hum:signal=fibre_force,amplitude=2", "clock-drift"]) == {
        "mains-hum": {"signal": "fibre_force", "amplitude": 2.0},
        "clock-drift": {},
    }
    with pytest.raises(ValueError, match="has no parameter"):
        parse_hidden(["guide-viscous-drag:size=2"])
