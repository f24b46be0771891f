"""A battery is drawn from its seed alone, and written stand by stand."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict, replace
from pathlib import Path

import h5py
import pytest

from mocks import effects
from mocks.battery.calibrate import main_size
from mocks.battery.draw import CLEAN, DOUBLE, OUTSIDE, PER_CAUSE, PULLS, Case, battery, size_for
from mocks.battery.store import forget, read_answer, write
from mocks.battery.strength import strength
from mocks.plant.motion import SITUATIONS, targets
from mocks.plant.operator import draw_stand
from mocks.plant.plant import GRID

DOWNWARD = ("end-stop", "fibre-pulley-slip")  # the nearer or the smaller, the stronger


@pytest.fixture(scope="module")
def cases() -> list[Case]:
    return battery(11)


def test_it_has_enough_of_every_kind(cases: list[Case]) -> None:
    kinds = Counter(case.kind for case in cases)
    catalogued = [effect.name for effect in effects.everything() if effect.catalogued]
    assert kinds == {"single": PER_CAUSE * len(catalogued), "clean": CLEAN, "double": DOUBLE, "outside": OUTSIDE}
    singles = Counter(name for case in cases if case.kind == "single" for name in case.hidden)
    assert singles == dict.fromkeys(catalogued, PER_CAUSE)
    assert all(len(case.hidden) == {"clean": 0, "double": 2}.get(case.kind, 1) for case in cases)


def test_it_is_mixed(cases: list[Case]) -> None:
    assert len({case.kind for case in cases[:40]}) == 4


def test_the_same_seed_gives_the_same_stands_and_another_seed_others() -> None:
    first, again, other = (battery(seed, ("single", "double"), 0.1) for seed in (11, 11, 12))
    assert [asdict(case) for case in again] == [asdict(case) for case in first]
    assert [case.seed for case in other] != [case.seed for case in first]


def test_a_part_of_it_holds_every_kind() -> None:
    assert {case.kind for case in battery(3, share=0.02)} == {"single", "clean", "double", "outside"}


def test_every_motion_can_be_driven(cases: list[Case]) -> None:
    for case in cases[::150]:
        assert len(case.motions) == 6
        for motion in case.motions:
            targets(motion, 10.0, GRID)


def test_sizes_grow_with_the_strength_that_is_wanted_and_stay_in_range() -> None:
    for name in set(effects.names()) - set(PULLS):
        size = main_size(effects.find(name))
        weak, strong = size_for(name, 2.0), size_for(name, 8.0)
        slack = 1e-9 * size.high
        assert size.low - slack <= min(weak, strong), name
        assert max(weak, strong) <= size.high + slack, name
        assert (weak >= strong) if size.null == float("inf") else (weak <= strong) or name in DOWNWARD, name


def test_a_base_parameter_is_pulled_by_the_wanted_number_of_its_sigmas(cases: list[Case]) -> None:
    for case in cases:
        if case.kind == "single" and "weight-mass" in case.hidden:
            difference = abs(float(case.hidden["weight-mass"]["difference"]))
            assert difference == pytest.approx(case.wanted["weight-mass"] * 0.03096)
            assert case.stand.hiding(case.hidden).weight_mass == case.stand.believed.weight_mass


def test_a_stand_is_written_once_and_its_truth_stays(cases: list[Case], tmp_path: Path) -> None:
    case = next(case for case in cases if case.kind == "single")
    case = replace(case, motions=case.motions[2:3])
    place = write(case, tmp_path, seconds=3.5)
    with h5py.File(place / "run-1.h5") as file:
        assert len(file["entry/data/time"]) == 7000
    assert read_answer(place)["hidden"][0]["name"] == next(iter(case.hidden))
    assert sorted(path.name for path in place.iterdir()) == ["run-1.h5", "truth.json"]
    forget(place)
    assert write(case, tmp_path, seconds=3.5) == place
    assert not (place / "run-1.h5").exists()


def test_strength_is_nothing_on_a_clean_stand_and_grows_with_the_size() -> None:
    stand, motions = draw_stand(0, errors=0.0), [SITUATIONS["gentle"]]

    def measured(coefficient: float) -> float:
        hidden = {"guide-viscous-drag": {"coefficient": coefficient}}
        return strength(stand, hidden, motions, seconds=3.0, windows=4)

    assert strength(stand, {}, motions, seconds=3.0, windows=4) < 0.15
    assert measured(8.0) == pytest.approx(4.0 * measured(2.0), rel=0.15)
    assert measured(8.0) > 1.0


def test_a_battery_of_single_runs_has_the_same_stands_with_one_of_their_motions() -> None:
    whole, short = battery(3, ("single",), 0.05), battery(3, ("single",), 0.05, runs=1)
    assert [c.hidden for c in short] == [c.hidden for c in whole]
    assert all(len(c.motions) == 1 and c.motions[0] in w.motions for c, w in zip(short, whole, strict=True))
    assert len({w.motions.index(c.motions[0]) for c, w in zip(short, whole, strict=True)}) > 2, "always the same run"
