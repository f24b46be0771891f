"""A stand comes from its file with units, goes back to text unchanged, and a bad key is named with a remedy."""

from __future__ import annotations

import math
import pickle

import pytest

from stand.config import DEFAULT, load_stand, load_stand_text
from stand.errors import InputError


def test_the_nominal_stand_is_the_published_one() -> None:
    stand = load_stand()
    assert stand.setup.weight_mass == 3.096
    assert stand.setup.incline_angle == pytest.approx(math.radians(30))
    assert stand.setup.sigma("fibre_stiffness") == pytest.approx(0.05 * 34e3)
    assert stand.limits.jerk == 400.0
    assert stand.limits.travel == (0.0, 0.1)


def test_a_stand_written_as_text_reads_back_equal_and_is_picklable() -> None:
    stand = load_stand()
    assert load_stand_text(stand.to_toml()) == stand
    assert pickle.loads(pickle.dumps(stand)) == stand


def test_an_announcement_sets_links_and_latencies() -> None:
    stand = load_stand().with_links(
        {
            "drive": {"tcp": "127.0.0.1:40123", "rtu": "/dev/pts/3", "unit_id": 1},
            "force_gauge": {"port": "/dev/pts/4", "baud": 230400},
            "dial_gauge": {"port": "/dev/pts/5", "baud": 460800},
            "latency": {"drive": 1e-5, "force_gauge": 5e-4, "dial_gauge": 4e-4},
        }
    )
    assert (stand.drive.link.host, stand.drive.link.port) == ("127.0.0.1", 40123)  # type: ignore[union-attr]
    assert stand.dial_gauge.link.baud == 460800
    assert stand.force_gauge.latency == 5e-4


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ('speed = "1 m/s"', 'speed = "3 kg"', "limits.speed.*'3 kg'.*Give it in m/s"),
        ('poll_rate = "100 Hz"', 'pollrate = "100 Hz"', "drive.pollrate.*Remove the key"),
        ('codec = "gsv-8"', "", "force_gauge.codec.*Add the key"),
        ('"3.096 kg"', '"3.096 stone"', "setup.weight_mass.*'stone'"),
        ("weight_mass", "wait_mass", "setup.wait_mass.*unknown key"),
        ('travel = ["0 mm", "100 mm"]', 'travel = ["100 mm", "0 mm"]', "travel"),
        ('"weight-fibre-pulley-drive"', '"crane"', "setup.system.*weight-fibre-pulley-drive"),
        ("[storage]", "[storage", "not valid TOML"),
    ],
)
def test_a_bad_file_is_refused_with_the_key_and_the_remedy(old: str, new: str, complaint: str) -> None:
    text = DEFAULT.read_text()
    assert old in text
    with pytest.raises(InputError, match=complaint) as refused:
        load_stand_text(text.replace(old, new, 1), "lab.toml")
    assert "lab.toml" in str(refused.value)
