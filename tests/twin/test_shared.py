"""Work shared with the helper is done once, all of it, and an error in it is nobody's secret."""

from __future__ import annotations

import threading
import time
from functools import partial

import numpy as np
import pytest

from twin.diagnosis.shared import WORTH, in_turn, shared, spread


def test_every_job_is_done_once_and_two_threads_do_them() -> None:
    done: list[tuple[int, int]] = []

    def job(number: int) -> None:
        time.sleep(0.005)
        done.append((number, threading.get_ident()))

    shared([partial(job, k) for k in range(12)])
    assert sorted(number for number, _ in done) == list(range(12))
    assert len({thread for _, thread in done}) == 2


@pytest.mark.parametrize(("n", "samples"), [(1, 10 * WORTH), (7, 1), (60, WORTH), (2, WORTH)])
def test_pieces_cover_everything(n: int, samples: int) -> None:
    seen = np.zeros(n, int)

    def work(first: int, last: int) -> None:
        seen[first:last] += 1

    spread(n, samples, work)
    assert np.all(seen == 1)


def test_where_a_job_fails_the_error_is_told_and_nothing_goes_on_behind_it() -> None:
    done: list[int] = []

    def job(number: int) -> None:
        time.sleep(0.01)
        if number == 1:
            raise ValueError("one")
        done.append(number)

    with pytest.raises(ValueError, match="one"):
        shared([partial(job, k) for k in range(40)])
    count = len(done)
    assert count < 10
    time.sleep(0.05)
    assert len(done) == count


def test_jobs_in_turn_are_done_two_at_a_time_and_none_beyond_the_next() -> None:
    begun: list[int] = []
    threads: set[int] = set()

    def job(number: int) -> int:
        begun.append(number)
        threads.add(threading.get_ident())
        time.sleep(0.02)
        return number * number

    promises = in_turn([partial(job, k) for k in range(6)])
    assert begun == []
    assert promises[0]() == 0
    assert sorted(begun) == [0, 1]
    assert [p() for p in promises[1:4]] == [1, 4, 9]
    assert len(begun) == len(set(begun)) <= 5
    assert len(threads) == 2
    assert promises[0]() == 0  # asked for again, not done again
    assert begun.count(0) == 1


def test_an_error_of_a_job_that_was_begun_ahead_is_told_where_it_is_asked_for() -> None:
    def job(number: int) -> int:
        if number == 1:
            raise ValueError("one")
        return number

    promises = in_turn([partial(job, k) for k in range(3)])
    assert promises[0]() == 0
    with pytest.raises(ValueError, match="one"):
        promises[1]()
    assert promises[2]() == 2
