"""CSV columns with a setup become a recording; whatever is unclear in them is named, not guessed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from stand.errors import InputError
from stand.recording import read_recording
from stand.recording.import_csv import import_csv

SETUP = """
[setup]
system = "weight-fibre-pulley-drive"
weight_mass = { value = "3096 g", uncertainty = "1 %" }
incline_angle = "30 deg"
[excitation]
shape = "trapezoidal"
frequency = "2 Hz"
amplitude = "20 mm"
ramp = "125 ms"
"""


@pytest.fixture
def setup(tmp_path: Path) -> Path:
    path = tmp_path / "setup.toml"
    path.write_text(SETUP)
    return path


def write(tmp_path: Path, heading: str, rows: list[str]) -> Path:
    path = tmp_path / "table.csv"
    path.write_text("\n".join(["# measured on a Monday", heading, *rows]) + "\n")
    return path


def test_millimetres_become_metres(tmp_path: Path, setup: Path) -> None:
    rows = [f"{k * 0.5},{k * 1.0},{k * 2.0},{15.0 + k}" for k in range(10)]
    recording = read_recording(import_csv(write(tmp_path, "time [ms],x [mm],u [mm],F [N]", rows), setup))
    assert recording.dt == pytest.approx(0.0005)
    np.testing.assert_allclose(recording.x, 0.001 * np.arange(10))
    np.testing.assert_allclose(recording.u, 0.002 * np.arange(10))
    assert recording.F[-1] == 24.0
    assert recording.setup.weight_mass == pytest.approx(3.096)
    assert recording.excitation is not None
    assert recording.excitation.ramp == pytest.approx(0.125)


def test_semicolons_and_decimal_commas_are_read(tmp_path: Path, setup: Path) -> None:
    rows = [f"{k / 2000:.4f};{k};{k};{k}".replace(".", ",") for k in range(10)]
    heading = "time (s);drive_position (mm);weight_position (mm);fibre_force (kN)"
    recording = read_recording(import_csv(write(tmp_path, heading, rows), setup))
    assert recording.F[1] == pytest.approx(1000.0)


def test_an_uneven_time_axis_is_resampled(tmp_path: Path, setup: Path) -> None:
    times = np.cumsum([0.0, 0.0004, 0.0006, 0.0007] * 20)[1:]
    rows = [f"{t:.6f},{2 * t:.8f},0,15" for t in times if t > 0]
    rows = list(dict.fromkeys(rows))
    recording = read_recording(import_csv(write(tmp_path, "t [s],x [m],u [m],F [N]", rows), setup))
    np.testing.assert_allclose(np.diff(recording.x), 0.001, atol=1e-6)


@pytest.mark.parametrize(
    ("heading", "row", "complaint"),
    [
        ("t [s],x [m],u [m],F", "0,0,0,0", "states no unit"),
        ("t [s],x [m],u [m]", "0,0,0", "no such column"),
        ("t [s],x [m],u [m],F [furlong]", "0,0,0,0", "unknown unit"),
        ("t [s],x [m],u [m],F [m]", "0,0,0,0", "does not measure"),
        ("t [s],x [m],u [m],F [N]", "0,0,0,0", "time does not rise"),
        ("t [s],x [m],u [m],F [N]", "0,0,zero,0", "could not convert"),
    ],
)
def test_what_is_unclear_is_named(tmp_path: Path, setup: Path, heading: str, row: str, complaint: str) -> None:
    with pytest.raises(InputError, match=complaint):
        import_csv(write(tmp_path, heading, [row] * 5), setup)


def test_an_existing_recording_is_kept(tmp_path: Path, setup: Path) -> None:
    (tmp_path / "table.h5").write_bytes(b"precious")
    rows = [f"{k},0,0,0" for k in range(9)]
    with pytest.raises(InputError, match="exists already"):
        import_csv(write(tmp_path, "t [s],x [m],u [m],F [N]", rows), setup)
