"""A recording is read from anyone's file, and a bad one is refused with where, the value and the remedy."""

from __future__ import annotations

import math
from pathlib import Path

import h5py
import numpy as np
import pytest

from stand.errors import InputError
from stand.excitation.spec import Excitation, Shape
from stand.recording import Recording, read_recording, write_recording
from stand.setup import Setup, System


@pytest.fixture
def foreign(tmp_path: Path) -> Path:
    """What another program wrote: data in mm and N, a setup in lab units, nothing else."""
    path = tmp_path / "foreign.h5"
    n = 2000
    with h5py.File(path, "w") as file:
        data = file.create_group("entry/data")
        for name, values, unit in [
            ("time", np.arange(n) * 0.5, "ms"),
            ("drive_position", np.linspace(0, 30, n), "mm"),
            ("weight_position", np.linspace(0, 29, n), "mm"),
            ("fibre_force", np.full(n, 0.0152), "kN"),
        ]:
            data.create_dataset(name, data=values).attrs["units"] = unit
        setup = file.create_group("entry/setup")
        setup["system"] = "weight-fibre-pulley-drive"
        for name, value, unit in [("weight_mass", 3096.0, "g"), ("incline_angle", 30.0, "deg")]:
            setup.create_dataset(name, data=value).attrs["units"] = unit
        setup["weight_mass"].attrs["uncertainty"] = 5.0
    return path


def test_a_foreign_file_with_data_and_setup_alone_is_read_in_si(foreign: Path) -> None:
    run = read_recording(foreign)
    assert run.dt == pytest.approx(0.0005)
    assert run.x[-1] == pytest.approx(0.030)
    assert run.F[0] == pytest.approx(15.2)
    assert run.setup.weight_mass == pytest.approx(3.096)
    assert run.setup.sigma("weight_mass") == pytest.approx(0.005)
    assert run.setup.incline_angle == pytest.approx(math.radians(30))
    assert any("nominal values are used" in note for note in run.notes)


def test_an_uncertainty_that_is_not_stated_is_five_per_cent_or_a_fifth_of_a_degree(foreign: Path) -> None:
    setup = read_recording(foreign).setup
    assert setup.sigma("fibre_stiffness") == pytest.approx(0.05 * 34e3)
    assert setup.sigma("incline_angle") == pytest.approx(math.radians(0.2))


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    t = np.arange(4000) / 2000
    channels = {"drive_position": 0.01 * np.sin(t), "weight_position": 0.01 * t, "fibre_force": 15 + t}
    ordered = Excitation(Shape.TRAPEZOIDAL, frequency=1.25, amplitude=0.03, ramp=0.2, cycles=2)
    setup = Setup(added_mass=5.035, uncertainty={"pulley_inertia": 1e-5})
    run = Recording(None, setup, t, channels, ordered, {"fibre_force": 0.12}, np.zeros(4000, np.uint8))
    back = read_recording(write_recording(run, tmp_path / "run.h5"))
    for name, values in channels.items():
        np.testing.assert_array_equal(back.channels[name], values)
    assert back.setup.added_mass == 5.035
    assert back.setup.uncertainty["pulley_inertia"] == pytest.approx(1e-5)
    assert back.excitation == ordered
    assert back.uncertainty["fibre_force"] == 0.12
    assert back.complete is True


def test_a_file_that_exists_is_not_overwritten(foreign: Path) -> None:
    run = read_recording(foreign)
    with pytest.raises(FileExistsError):
        write_recording(run, foreign)


def _edit(path: Path, key: str, **attributes: object) -> None:
    with h5py.File(path, "r+") as file:
        for name, value in attributes.items():
            file[key].attrs[name] = value


def test_an_unknown_unit_is_an_error_that_names_it(foreign: Path) -> None:
    _edit(foreign, "entry/data/fibre_force", units="lbf")
    with pytest.raises(InputError, match=r"fibre_force.*'lbf'"):
        read_recording(foreign)


def test_a_channel_without_units_is_refused(foreign: Path) -> None:
    with h5py.File(foreign, "r+") as file:
        del file["entry/data/weight_position"].attrs["units"]
    with pytest.raises(InputError, match=r"weight_position.*no @units"):
        read_recording(foreign)


def test_time_that_is_not_uniform_is_refused_with_the_step(foreign: Path) -> None:
    with h5py.File(foreign, "r+") as file:
        file["entry/data/time"][1000:] += 3.0
    with pytest.raises(InputError, match="step 999"):
        read_recording(foreign)


def test_channels_of_unequal_length_are_refused(foreign: Path) -> None:
    with h5py.File(foreign, "r+") as file:
        del file["entry/data/fibre_force"]
        file["entry/data"].create_dataset("fibre_force", data=np.zeros(7)).attrs["units"] = "N"
    with pytest.raises(InputError, match="7 samples against 2000"):
        read_recording(foreign)


def test_an_unknown_system_lists_the_known_ones(foreign: Path) -> None:
    with h5py.File(foreign, "r+") as file:
        del file["entry/setup/system"]
        file["entry/setup/system"] = "crane"
    with pytest.raises(InputError, match="weight-fibre-pulley-drive"):
        read_recording(foreign)


def test_a_setup_without_the_weight_is_refused(foreign: Path) -> None:
    with h5py.File(foreign, "r+") as file:
        del file["entry/setup/weight_mass"]
    with pytest.raises(InputError, match="weight_mass"):
        read_recording(foreign)


def test_strands_that_disagree_with_the_fibre_are_warned_about(foreign: Path) -> None:
    with h5py.File(foreign, "r+") as file:
        file["entry/setup"].create_dataset("fibre_length", data=2.5).attrs["units"] = "m"
    assert any("disagrees" in note for note in read_recording(foreign).notes)


def test_a_linear_drive_needs_its_moving_mass_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "axis.h5"
    with h5py.File(path, "w") as file:
        data = file.create_group("entry/data")
        for name, unit in [("time", "s"), ("drive_position", "m"), ("drive_force", "N")]:
            data.create_dataset(name, data=np.arange(50) / 100).attrs["units"] = unit
        file["entry/setup/system"] = "linear-drive"
        file["entry/setup"].create_dataset("moving_mass", data=12.0).attrs["units"] = "kg"
    run = read_recording(path)
    assert run.setup.system is System.LINEAR_DRIVE
    assert run.setup.moving_mass == 12.0


def test_a_text_file_is_not_a_recording(tmp_path: Path) -> None:
    path = tmp_path / "notes.h5"
    path.write_text("not HDF5")
    with pytest.raises(InputError, match="doctor --recover"):
        read_recording(path)
