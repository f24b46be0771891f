"""Work shared with the helper is done once, all of it, and an error in it is nobody's secret."""

from __future__ import annotations

import threading
import time
from functools import partial

import numpy as np
import pytest

from twin.diagnosis.shared import WORTH, shared, spread


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
