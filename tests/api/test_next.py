"""Experiment, diagnosis, the experiment that it proposes, and the diagnosis of both: by requests alone."""

from __future__ import annotations

import json
from typing import Any

import pytest

from tests.api.conftest import Server

FIRST = {"shape": "trapezoidal", "frequency": 1.25, "amplitude": 0.03, "ramp": 0.2, "cycles": 5}


def follow_up(server: Server, run: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """The proposed experiment after its end, and the diagnosis that followed by itself."""
    before = {job["id"] for job in server.http.get("/jobs").json()}
    answer = server.http.post(f"/runs/{run}/next-experiment")
    assert answer.status_code == 201, answer.text
    ended = server.ended(answer.json()["id"])
    assert ended["state"] == "finished", ended["why"]

    def done(jobs: list[dict[str, Any]]) -> bool:
        return any(j["kind"] == "diagnose" and j["id"] not in before and j["state"] in ("done", "failed") for j in jobs)

    jobs = server.until("/jobs", done, seconds=200.0)
    return ended, next(j for j in jobs if j["kind"] == "diagnose" and j["id"] not in before)


@pytest.mark.slow
def test_what_a_diagnosis_proposes_is_run_and_judged_with_what_was_there(server: Server) -> None:
    first = server.ended(server.order(**FIRST)["id"])
    assert first["state"] == "finished", first
    asked = server.http.post("/diagnoses", json={"runs": [first["run"]]}).json()
    found = server.until(f"/diagnoses/{asked['id']}", lambda job: job["state"] in ("done", "failed"), seconds=200.0)
    assert found["state"] == "done", found["error"]
    proposal = found["verdict"]["next_experiment"]
    second, job = follow_up(server, first["run"])
    for name, value in proposal["excitation"].items():
        assert second["order"][name] == pytest.approx(value), name
    assert second["order"]["comment"] == proposal["why"][:200]
    assert job["state"] == "done", job["error"]
    verdict = server.http.get(f"/runs/{second['run']}/diagnosis").json()
    assert {run["file"] for run in verdict["baseline"]["runs"]} == {f"{first['run']}.h5", f"{second['run']}.h5"}
    if verdict["next_experiment"]:
        third, job = follow_up(server, second["run"])
        assert third["run"] not in (first["run"], second["run"])
        assert job["state"] == "done", job["error"]
        assert len(json.dumps(job["files"]).split(".h5")) - 1 == 3


def test_a_run_that_proposes_nothing_says_so(server: Server) -> None:
    assert server.http.post("/runs/none/next-experiment").status_code == 404
    (server.folder / "calm.h5").write_bytes(b"")
    (server.folder / "calm.diagnosis.json").write_text(json.dumps({"next_experiment": None}))
    answer = server.http.post("/runs/calm/next-experiment")
    (server.folder / "calm.h5").unlink()
    assert answer.status_code == 404
    assert "proposes no further experiment" in answer.json()["detail"]
