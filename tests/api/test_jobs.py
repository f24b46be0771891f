"""Work after runs: processes of their own, one at a time, told about while they run."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from api.jobs import Job, Jobs
from api.problem import NotFound


def test_a_job_that_can_not_be_done_says_why_in_one_line(tmp_path: Path) -> None:
    ended, told = threading.Event(), []

    def changed(job: Job) -> None:
        told.append(job)
        if job.state in ("done", "failed"):
            ended.set()

    jobs = Jobs(changed)
    jobs.submit("compare", [tmp_path / "none.h5"])
    assert ended.wait(30.0)
    jobs.close()
    assert [job.state for job in told if job.what == ""][:2] == ["queued", "running"]
    assert told[-1].state == "failed"
    assert "none.h5" in told[-1].error


def test_jobs_wait_while_the_stand_moves(tmp_path: Path) -> None:
    jobs = Jobs()
    jobs.hold(True)
    job = jobs.submit("compare", [tmp_path / "none.h5"])
    assert jobs.get(job.id).state == "queued"
    jobs.close()
    assert jobs.get(job.id).state == "queued"


def test_an_unknown_job_is_not_found() -> None:
    jobs = Jobs()
    with pytest.raises(NotFound):
        jobs.get("none")
    jobs.close()
