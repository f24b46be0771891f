"""Wrong files, values and places at the command line: what, where, the value and the remedy, exit code 2."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest

from api.cli import run
from stand.config import DEFAULT
from stand.recording import read_recording

T = np.arange(3000) / 2000
MOTION = 0.01 * np.clip(np.sin(6 * T - 3), 0, 1)
COLUMNS = np.column_stack([T, 1e3 * MOTION, 1e3 * MOTION + 1e-3 * np.sin(900 * T), 15 + np.sin(500 * T)])
HEAD = "time [s]; x [mm]; u [mm]; F [N]"
SETUP = '[setup]\nsystem = "weight-fibre-pulley-drive"\nweight_mass = "3.1 kg"\n'
Refused = Callable[..., str]


@pytest.fixture
def refused(capfd: pytest.CaptureFixture[str]) -> Refused:
    """The one message of a command line that ends with exit code 2."""

    def call(*arguments: object) -> str:
        capfd.readouterr()
        code = run([str(argument) for argument in arguments])
        told = capfd.readouterr().err
        assert code == 2, told
        assert "Traceback" not in told
        assert "error of the program" not in told
        return " ".join(told.split())

    return call


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Two groups written by plain h5py."""
    path = tmp_path / "run.h5"
    values = {"time": (T, "s"), "drive_position": (MOTION, "m"), "weight_position": (MOTION, "m")}
    with h5py.File(path, "w") as file:
        for name, (series, unit) in (values | {"fibre_force": (15 + np.sin(500 * T), "N")}).items():
            file.create_dataset(f"entry/data/{name}", data=series).attrs["units"] = unit
        file["entry/setup/system"] = "weight-fibre-pulley-drive"
        for name, value, unit in (("weight_mass", 3.096, "kg"), ("incline_angle", 30.0, "deg")):
            file.create_dataset(f"entry/setup/{name}", data=value).attrs["units"] = unit
    return path


def _units(file: h5py.File) -> None:
    file["entry/data/drive_position"].attrs["units"] = "furlong"


def _constant(file: h5py.File) -> None:
    file["entry/data/fibre_force"][:] = 15.25


def _missing_number(file: h5py.File) -> None:
    file["entry/data/fibre_force"][1000] = np.nan


def _gap(file: h5py.File) -> None:
    file["entry/data/time"][2000:] = T[2000:] + 0.2


def _backwards(file: h5py.File) -> None:
    file["entry/data/time"][:] = T[::-1]


def _no_setup(file: h5py.File) -> None:
    del file["entry/setup"]


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (_units, r"run\.h5:/entry/data/drive_position: unknown unit 'furlong'.* Use SI"),
        (_constant, r"/entry/data/fibre_force: is constant.* \(got 15\.25\)\. Check its cable"),
        (_missing_number, r"fibre_force: 1 samples are not numbers, the first at 0\.5000 s\. Cut the run"),
        (_gap, r"/entry/data/time: time is not uniform: step 1999 is 0\.2005 s.*`stand import`"),
        (_backwards, r"/entry/data/time: time does not rise \(got -0\.0005\)\. Put the samples in the order"),
        (_no_setup, r"run\.h5:/entry/setup: missing group\. A recording needs"),
    ],
)
def test_a_recording_that_cannot_be_compared_says_why(
    refused: Refused, recording: Path, spoil: Callable[[h5py.File], None], told: str
) -> None:
    with h5py.File(recording, "r+") as file:
        spoil(file)
    assert re.search(told, refused("compare", recording))


@pytest.mark.parametrize("command", ["compare", "diagnose", "doctor", "replay", "simulate"])
def test_half_a_file_and_a_folder_and_nothing_are_told_apart(refused: Refused, recording: Path, command: str) -> None:
    content = recording.read_bytes()
    recording.write_bytes(content[: len(content) // 2])
    assert "not a readable HDF5 file" in refused(command, recording)
    assert "is a folder" in refused(command, recording.parent)
    assert "no such file" in refused(command, recording.with_name("other.h5"))


def test_a_result_is_refused_before_any_work_where_it_has_no_place(refused: Refused, recording: Path) -> None:
    nowhere = recording.parent / "nowhere"
    for option, file in (("--json", "a.json"), ("--page", "a.html")):
        assert f"{option}: no such folder" in refused("compare", recording, option, nowhere / file)
        assert f"{option}: no such folder" in refused("diagnose", recording, option, nowhere / file)
    assert "--page: is a folder" in refused("compare", recording, "--page", recording.parent)
    assert "no such folder" in refused("simulate", recording, "--out", nowhere / "s.h5")
    order = ("--shape", "trapezoidal", "--frequency", 1, "--amplitude", 0.01, "--ramp", 0.2, "--duration", 1)
    assert "--out: can't be made" in refused("run", *order, "--simulated", "--out", recording / "runs")


@pytest.fixture
def table(tmp_path: Path) -> Callable[..., tuple[object, ...]]:
    """Arguments of an import."""

    def write(values: np.ndarray = COLUMNS, head: str = HEAD, setup: str = SETUP) -> tuple[object, ...]:
        np.savetxt(tmp_path / "t.csv", values, delimiter=";", header=head, comments="")
        (tmp_path / "setup.toml").write_text(setup)
        return ("import", tmp_path / "t.csv", "--setup", tmp_path / "setup.toml")

    return write


@pytest.mark.parametrize(
    ("head", "setup", "told"),
    [
        (HEAD.replace("x [mm]", "x [furlong]"), SETUP, r"t\.csv: column 'x \[furlong\]': unknown unit"),
        (HEAD.replace("F [N]", "F [kg]"), SETUP, r"unit 'kg' does not measure what 'N' does.* Give it in N"),
        (HEAD.replace("F [N]", "F"), SETUP, r"column 'F': states no unit\. Head it like \"fibre_force \[N\]\""),
        (HEAD.replace("u [mm]", "y [mm]"), SETUP, r"weight_position: no such column\. Head one column"),
        (HEAD, "x = 1\n", r"setup\.toml: \[setup\]: missing"),
        (HEAD, SETUP.replace("weight", "weigth", 2), r"unknown"),
        (HEAD, SETUP.replace("3.1 kg", "3.1 m"), r"setup\.weight_mass: unit 'm' does not measure what 'kg'"),
        (HEAD, SETUP.replace("3.1 kg", "-3.1 kg"), r"weight_mass: must be positive \(got -3\.1\)"),
        (HEAD, "[setup\n", r"setup\.toml: not valid TOML.*line 1"),
    ],
)
def test_columns_and_a_setup_that_do_not_fit_are_refused(
    refused: Refused, table: Callable[..., tuple[object, ...]], head: str, setup: str, told: str
) -> None:
    assert re.search(told, refused(*table(head=head, setup=setup)))


def test_a_table_with_a_number_missing_or_times_out_of_order_is_refused_with_its_line(
    refused: Refused, table: Callable[..., tuple[object, ...]]
) -> None:
    values = COLUMNS.copy()
    values[99, 3] = np.nan
    assert "sample 100: not a finite number. Remove or mend the line" in refused(*table(values))
    values = COLUMNS.copy()
    values[[50, 51]] = values[[51, 50]]
    assert re.search(r"sample 52: time does not rise \(got 0\.025\)\. Put the lines", refused(*table(values)))


def test_a_gap_in_a_table_is_bridged_marked_and_told(
    table: Callable[..., tuple[object, ...]], capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    values = COLUMNS.copy()
    values[1000:, 0] += 0.15
    assert run([str(argument) for argument in table(values)]) == 0
    assert re.search(r"quality: 9\.\d+ % of samples marked", capfd.readouterr().out)
    quality = read_recording(tmp_path / "t.h5").quality
    assert quality is not None
    assert np.flatnonzero(quality).tolist() == list(range(1001, 1299))
    assert set(quality[1001:1299]) == {7}


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"gsv-8"', '"gsv-9"', r"force_gauge\.codec: no codec of that name \(got 'gsv-9'\)\. Known: gsv-8, hl-g1"),
        ('"nanotec-cia402"', '"x"', r"drive\.profile: no drive profile of that name \(got 'x'\)\. Known: igus-d1"),
        ('"1 m/s"', '"1 kg"', r"limits\.speed: unit 'kg' does not measure what 'm/s' does"),
        ("port = 502", "port = 0", r"drive\.link\.port: input should be greater"),
        ("poll_rate", "pol_rate", r"drive\.pol_rate: extra inputs are not permitted.* Remove the key or mend"),
        ("codec", "codec", r"force_gauge\.link\.port: no such port \(got '/dev/ttyUSB0'\)\. Plug it in"),
    ],
)
def test_a_stand_that_is_described_wrongly_or_is_not_there_moves_nothing(
    refused: Refused, tmp_path: Path, old: str, new: str, told: str
) -> None:
    text = DEFAULT.read_text()
    assert old in text
    path = tmp_path / "stand.toml"
    path.write_text(text.replace(old, new, 1))
    assert re.search(told, refused("run", "--situation", "2", "--stand", path, "--out", tmp_path))


def test_an_effect_that_nobody_knows_is_named_with_those_that_there_are(refused: Refused, tmp_path: Path) -> None:
    told = refused("run", "--situation", "2", "--simulated", "--hide", "magic", "--out", tmp_path)
    assert "magic" in told
    assert "guide-viscous-drag" in told


def test_situations_models_and_values_that_do_not_exist_are_named(refused: Refused, recording: Path) -> None:
    assert "Known: 2, 3c, 7a, 10, 11" in refused("run", "--situation", "99", "--simulated")
    assert "no FibreModel of that name (got 'magic')" in refused("compare", recording, "--model", "magic")
    negative = ("--simulated", "--frequency", -1, "--amplitude", 0.01, "--ramp", 0.2, "--duration", 1)
    assert "frequency: must be positive (got -1.0). Give it in Hz" in refused(
        "run", "--shape", "trapezoidal", *negative, "--simulated"
    )


def test_a_device_that_does_not_answer_is_no_good_news(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("api.checkup.check_environment", lambda tell: [])
    path = tmp_path / "stand.toml"
    path.write_text(DEFAULT.read_text().replace("port = 502", "port = 1"))
    assert run(["doctor", "--stand", str(path)]) == 1
    rows = capfd.readouterr().out
    assert re.search(r"bad\s+drive\s+127\.0\.0\.1:1: can't connect .*refused", rows)
    assert re.search(r"bad\s+force_gauge .*/dev/ttyUSB0", rows)
