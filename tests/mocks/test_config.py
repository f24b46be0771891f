"""A simulated stand's files: its configuration with what is said of a mistake, and its ledger."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mocks.config import ConfigError, load, parse, parse_hide
from mocks.ledger import Ledger, Rows, read_events, read_samples
from mocks.timing import timing


def test_nothing_said_is_the_published_stand() -> None:
    config = load(None)
    assert config.force_gauge.baud == 230_400
    assert config.dial_gauge.baud == 921_600
    assert config.hidden == {}


def test_a_file_says_what_differs(tmp_path: Path) -> None:
    text = """
        seed = 4
        [drive]
        word_order = "little"
        drift_ppm = 0
        [dial_gauge]
        bunching = 0.016
        jitter = [1e-4, 3e-4]
        [force_gauge]
        bunching = "none"
        [plant]
        fibre_stiffness = 35e3
        [hidden.guide-viscous-drag]
        coefficient = 8.0
        [[faults]]
        at = 2.5
        command = "fault drive"
    """
    (tmp_path / "stand.toml").write_text(text)
    config = load(tmp_path / "stand.toml")
    assert (config.seed, config.drive.word_order, config.drive.drift_ppm) == (4, "little", 0.0)
    assert (config.dial_gauge.bunching, config.dial_gauge.jitter, config.force_gauge.bunching) == (
        0.016,
        (1e-4, 3e-4),
        0,
    )
    assert config.dial_gauge.baud == 921_600
    assert config.plant == {"fibre_stiffness": 35e3}
    assert config.hidden == {"guide-viscous-drag": {"coefficient": 8.0}}
    assert config.faults[0].command == "fault drive"


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ({"sead": 1}, "sead: unknown key .got 1.. There are seed"),
        ({"drive": {"word_order": "middle"}}, "drive.word_order: not one of the choices .got 'middle'.. Choose big or"),
        ({"force_gauge": {"baud": "fast"}}, "force_gauge.baud: not a whole number it can be .got 'fast'"),
        ({"force_gauge": {"noise": -1.0}}, "force_gauge.noise: not a number it can be .got -1.0"),
        ({"dial_gauge": {"jitter": [3e-4, 1e-4]}}, "dial_gauge.jitter: not a least and a most"),
        ({"drive": 3}, "drive: is not a table"),
        ({"plant": {"mass": 3.0}}, "plant.mass: unknown key"),
        ({"hidden": {"gremlin": {}}}, "hidden.gremlin: no such effect"),
        ({"hidden": {"guide-viscous-drag": {"amount": 1.0}}}, "has no parameter 'amount'"),
        ({"faults": [{"when": 1.0}]}, r"faults\[0\]: is no fault"),
    ],
)
def test_a_mistake_is_told_with_its_place_and_remedy(table: dict[str, object], told: str) -> None:
    with pytest.raises(ConfigError, match=told):
        parse(table)


def test_a_hidden_effect_can_be_named_on_the_command_line() -> None:
    assert parse_hide(["guide-viscous-drag:coefficient=8"]) == {"guide-viscous-drag": {"coefficient": 8.0}}
    with pytest.raises(ConfigError, match="There are"):
        parse_hide(["gremlin"])


def test_the_effects_that_can_be_hidden_are_told_as_json() -> None:
    told = subprocess.run([sys.executable, "-m", "mocks", "effects"], capture_output=True, text=True, check=True).stdout
    found = {effect["name"]: effect for effect in json.loads(told)}
    assert found["guide-viscous-drag"]["catalogued"]
    assert found["guide-viscous-drag"]["sizes"].keys() == {"coefficient"}


def test_an_unknown_command_is_refused() -> None:
    done = subprocess.run([sys.executable, "-m", "mocks", "dance"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "serve" in done.stderr


def test_a_ledger_tells_how_time_was_kept(tmp_path: Path) -> None:
    ledger = Ledger(tmp_path, {})
    counter = np.array([7, 8, 10])
    rows = Rows.of(counter, counter / 2e3, 5.0 + counter / 2e3, np.zeros(3), np.zeros(3))
    rows.handed[:] = rows.true_time + 0.5e-3
    for device in ("force_gauge", "dial_gauge"):
        ledger.rows(device, rows)
    ledger.flush()
    found = timing(tmp_path)["force_gauge"]
    ledger.close()
    assert (found["samples"], found["gaps"], found["overrun"]) == (3, 1, 0)
    assert found["rate"] == pytest.approx(2000.0)
    assert found["handed_after"]["50"] == pytest.approx(0.5e-3)


def test_a_ledger_that_was_cut_off_is_read_up_to_there(tmp_path: Path) -> None:
    ledger = Ledger(tmp_path, {})
    ledger.rows("drive", Rows.of(np.arange(4), np.zeros(4), np.zeros(4), np.zeros(4), np.zeros(4)))
    ledger.event(1.0, "fault", code=3)
    ledger.close()
    for name, cut in (("drive.bin", 9), ("events.jsonl", 0)):
        data = (tmp_path / name).read_bytes()
        (tmp_path / name).write_bytes(data[: len(data) - cut] + (b'{"time": 2' if not cut else b""))
    assert read_samples(tmp_path, "drive")["counter"].tolist() == [0, 1, 2]
    assert read_events(tmp_path) == [{"time": 1.0, "kind": "fault", "code": 3}]
