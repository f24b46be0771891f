"""The command line as a user meets it: subprocesses, exit codes, one clear message."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from api.cli import run
from api.cli._build import names
from stand.recording import Recording, write_recording
from stand.setup import nominal


@dataclass
class Done:
    """How a command line ended."""

    returncode: int
    stdout: str
    stderr: str


Stand = Callable[..., Done]


@pytest.fixture
def stand(capfd: pytest.CaptureFixture[str]) -> Stand:
    """A command line, run in this process: what it loads is loaded once for all tests."""

    def call(*arguments: object) -> Done:
        capfd.readouterr()
        code = run([str(argument) for argument in arguments])
        return Done(code, *capfd.readouterr())

    return call


def process(*arguments: str) -> subprocess.CompletedProcess[str]:
    """The same as a user's shell starts it."""
    return subprocess.run([sys.executable, "-m", "api.cli", *arguments], capture_output=True, text=True, timeout=60)


@pytest.fixture
def resting(tmp_path: Path) -> Path:
    t = np.arange(2400) / 2000
    noise = np.random.default_rng(1).normal(size=t.size)
    channels = {
        "drive_position": 1e-2 * np.sin(t) ** 4,
        "weight_position": 1e-2 * np.sin(t) ** 4 + 1e-6 * noise,
        "fibre_force": 15.2 + 0.1 * noise,
    }
    return write_recording(Recording(None, nominal(), t, channels), tmp_path / "run.h5")


def test_help_lists_every_command_found_in_the_folder() -> None:
    text = process("--help").stdout
    wanted = "causes compare demo diagnose doctor fit import models profiles replay run serve simulate situations"
    assert set(wanted.split()) == set(names())
    for name in wanted.split():
        assert f"\n  {name} " in text


@pytest.mark.parametrize("list_", ["models", "situations", "profiles", "doctor"])
def test_a_list_that_needs_no_kernel_does_not_wait_for_the_compiler(list_: str) -> None:
    said = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "api.cli", list_], capture_output=True, text=True, timeout=60
    )
    assert said.returncode == 0
    assert "api.cli._build" in said.stderr
    assert "llvmlite" not in said.stderr


def test_help_comes_quickly() -> None:
    """Median of three: 0.4 s is what a person takes for at once (0.17 s when quiet; doubled under load)."""
    seconds = []
    for _ in range(3):
        began = time.monotonic()
        process("--help")
        seconds.append(time.monotonic() - began)
    assert sorted(seconds)[1] < 1.0


@pytest.mark.parametrize("name", sorted(names()))
def test_each_command_shows_an_example(stand: Stand, name: str) -> None:
    done = stand(name, "--help")
    assert done.returncode == 0
    assert f"stand {name}" in done.stdout.partition("Example:")[2]


def test_an_unknown_command_is_bad_input_with_a_proposal() -> None:
    done = process("modelz")
    assert done.returncode == 2
    assert "models" in done.stderr


def test_a_missing_file_is_bad_input_told_in_one_line() -> None:
    done = process("compare", "no-such-run.h5")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "no-such-run.h5" in done.stderr


def test_an_impossible_order_names_field_value_and_remedy(stand: Stand) -> None:
    done = stand(
        "simulate", "--shape", "trapezoidal", "--frequency", 1, "--amplitude", 0.5, "--ramp", 0.2, "--duration", 5
    )
    assert done.returncode == 2
    assert "amplitude" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_word_where_a_shape_belongs_is_bad_input(stand: Stand) -> None:
    done = stand("run", "--shape", "triangular", "--simulated")
    assert done.returncode == 2
    assert "--shape" in done.stderr


def test_running_without_a_stand_says_what_to_give(stand: Stand) -> None:
    done = stand("run", "--situation", "2")
    assert done.returncode == 2
    assert "--simulated" in done.stderr


def test_situations_are_printed_and_written_as_json(stand: Stand, tmp_path: Path) -> None:
    done = stand("situations", "--json", tmp_path / "s.json")
    assert done.returncode == 0
    found = json.loads((tmp_path / "s.json").read_text())
    assert [s["name"] for s in found] == ["2", "3c", "7a", "10", "11"]
    assert found[1]["published_R"]["weight_position"]["velocity_dependent_damping"] == 0.919


def test_json_on_stdout_is_alone_there(stand: Stand) -> None:
    assert json.loads(stand("profiles", "--json", "-").stdout)


def test_doctor_finds_a_good_recording_good(stand: Stand, resting: Path) -> None:
    done = stand("doctor", resting)
    assert done.returncode == 0, done.stdout
    assert "2400 samples" in done.stdout


def test_doctor_finds_a_constant_channel_and_says_so(stand: Stand, resting: Path) -> None:
    import h5py

    with h5py.File(resting, "r+") as file:
        file["entry/data/fibre_force"][:] = 15.0
    done = stand("doctor", resting)
    assert done.returncode == 1
    assert "constant" in done.stdout


def test_import_makes_a_recording_from_columns(stand: Stand, tmp_path: Path) -> None:
    t = np.arange(0, 1.5, 0.0005)
    columns = np.column_stack([t, 10 * np.sin(t), 10 * np.sin(t), 15 + 0 * t])
    table = tmp_path / "measured.csv"
    np.savetxt(table, columns, delimiter=";", header="time [s]; x [mm]; u [mm]; F [N]", comments="")
    (tmp_path / "setup.toml").write_text('[setup]\nsystem = "weight-fibre-pulley-drive"\nweight_mass = "3.1 kg"\n')
    done = stand("import", table, "--setup", tmp_path / "setup.toml")
    assert done.returncode == 0, done.stderr
    assert "3000 samples at 2000 Hz" in done.stdout
    assert (tmp_path / "measured.h5").exists()


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A short recording by a program that is not ours."""
    path = tmp_path_factory.mktemp("recorded") / "run.h5"
    order = ["--situation", "2", "--seconds", "4", "--seed", "3", "--out", str(path)]
    subprocess.run([sys.executable, "-m", "mocks", "record", *order], check=True, capture_output=True, timeout=100)
    return path


def test_compare_prints_scores_and_writes_json_and_page(stand: Stand, recorded: Path, tmp_path: Path) -> None:
    done = stand("compare", recorded, "--json", tmp_path / "c.json", "--page", tmp_path / "c.html")
    assert done.returncode == 0, done.stderr
    baseline = json.loads((tmp_path / "c.json").read_text())["baseline"]["runs"][0]
    assert baseline["file"] == "run.h5"
    assert f"{baseline['weight_position']['R']:.4g}" in done.stdout
    assert "http" not in (tmp_path / "c.html").read_text()[:2000]


def test_compare_with_several_models_puts_them_side_by_side(stand: Stand, recorded: Path, tmp_path: Path) -> None:
    page = tmp_path / "c.html"
    done = stand("compare", recorded, "--model", "force", "--model", "force-damping", "--page", page, "--json", "-")
    assert [model["name"] for model in json.loads(done.stdout)["models"]] == ["force", "force-damping"]


def test_simulate_takes_the_drive_from_a_recording_and_saves_one(stand: Stand, recorded: Path, tmp_path: Path) -> None:
    done = stand("simulate", recorded, "--out", tmp_path / "s.h5")
    assert done.returncode == 0, done.stderr
    assert stand("doctor", tmp_path / "s.h5").returncode == 0
