"""The REST interface and the live stream, on a real server with a simulated stand behind it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import h5py
import httpx
import pytest
from websockets.exceptions import InvalidStatus

from api.cli import run
from tests.api.conftest import ORDER, Server


def test_validating_names_each_field_and_moves_nothing(server: Server) -> None:
    good = server.http.post("/experiments/validate", json=ORDER).json()
    bad = server.http.post("/experiments/validate", json={**ORDER, "amplitude": 0.5}).json()
    assert good["valid"]
    assert good["plan"]["seconds"] == pytest.approx(3.0, abs=0.2)
    assert not bad["valid"]
    assert bad["errors"][0]["field"] == "amplitude"
    assert server.http.get("/experiments").json() == []


def test_an_order_that_is_no_order_is_a_problem(server: Server) -> None:
    answer = server.http.post("/experiments", json={"shape": "triangular"})
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["errors"][0]["field"] == "shape"


def test_what_is_not_there_is_a_problem_too(server: Server) -> None:
    for path in ("/runs/none", "/experiments/none", "/diagnoses/none", "/nowhere"):
        answer = server.http.get(path)
        assert (answer.status_code, answer.headers["content-type"]) == (404, "application/problem+json")


def test_moving_without_the_token_is_refused(server: Server) -> None:
    for path in ("/experiments", "/stand/home", "/stand/jog", "/stand/reset"):
        assert httpx.post(server.url + path, json=ORDER).status_code == 401


def test_the_printed_address_hands_the_browser_its_cookie(server: Server) -> None:
    with httpx.Client(base_url=server.url) as browser:
        answer = browser.get("/", params={"token": server.token})
        assert answer.headers["location"] == "/"
        assert "HttpOnly" in answer.headers["set-cookie"]
        assert "samesite=strict" in answer.headers["set-cookie"].lower()
        assert browser.post("/experiments/none/stop").status_code == 404


def test_a_foreign_page_can_not_open_the_live_stream(server: Server) -> None:
    with pytest.raises(InvalidStatus), server.listen(origin="http://evil.example"):
        pass


def test_openapi_shows_examples_and_problems(server: Server) -> None:
    document = server.http.get("/openapi.json").json()
    assert document["components"]["schemas"]["Order"]["examples"]
    assert "application/problem+json" in json.dumps(document["paths"]["/experiments"])


def test_the_stand_tells_its_devices(server: Server) -> None:
    devices = {device["name"]: device for device in server.http.get("/stand").json()["devices"]}
    assert set(devices) == {"drive", "force_gauge", "dial_gauge"}
    assert {device["state"] for device in devices.values()} == {"ok"}


@pytest.fixture(scope="module")
def done(server: Server) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """One whole experiment: its last view, and all that the live stream told."""
    told: list[dict[str, Any]] = []
    with server.listen() as socket:
        started = server.order(comment="by a test")
        assert server.http.post("/experiments", json=ORDER).status_code == 409
        for text in socket:
            told.append(json.loads(text))
            if told[-1]["type"] == "experiment" and told[-1]["state"] not in ("starting", "running"):
                break
    return server.ended(started["id"]), told


def test_an_experiment_ends_as_a_run_in_the_list(server: Server, done: tuple[dict[str, Any], Any]) -> None:
    view, _ = done
    assert (view["state"], view["why"]) == ("finished", "")
    run = server.until(f"/runs/{view['run']}", lambda found: found["jobs"])
    assert run["complete"]
    assert run["seconds"] == pytest.approx(view["seconds"], abs=0.2)
    with h5py.File(server.folder / f"{view['run']}.h5") as file:
        assert "live" in file["entry"]


def test_the_live_stream_brought_every_sample_time_with_its_simulation(done: tuple[dict[str, Any], list[Any]]) -> None:
    view, told = done
    blocks = [message for message in told if message["type"] == "block" and "t" in message]
    times = [t for block in blocks for t in block["t"]]
    assert times == sorted(times)
    assert len(times) * 0.004 == pytest.approx(view["seconds"], abs=0.25)
    simulated = [t for message in told if "t_sim" in message for t in message["t_sim"]]
    assert len(simulated) == pytest.approx(len(times), abs=3)
    assert -1.0 <= blocks[-1]["score"]["u"]["R"] <= 1.0


def test_live_values_are_fresh(done: tuple[dict[str, Any], Any]) -> None:
    """The median, even with other tests beside; the soak test holds the 99th percentile to 0.1 s."""
    assert done[0]["latency"]["p50"] < 2.0


def test_after_the_run_comparison_and_page_lie_beside_it(server: Server, done: tuple[dict[str, Any], Any]) -> None:
    name = done[0]["run"]
    run = server.until(f"/runs/{name}", lambda run: "comparison-page" in run["links"])
    baseline = server.http.get(run["links"]["comparison"]).json()["baseline"]["runs"][0]
    assert baseline["weight_position"]["R"] > 0.9
    page = server.http.get(run["links"]["comparison-page"])
    assert "sandbox" in page.headers["content-security-policy"]
    assert "<html" in page.text
    assert server.http.get(run["links"]["file"]).content[:4] == b"\x89HDF"


def test_a_replay_of_the_run_comes_to_the_same_scores(
    server: Server, done: tuple[dict[str, Any], Any], tmp_path: Path
) -> None:
    name = done[0]["run"]
    server.until(f"/runs/{name}", lambda run: "comparison" in run["links"])
    recorded, told = server.folder / f"{name}.h5", tmp_path / "told.json"
    assert run(["replay", str(recorded), "--speed", "max", "--out", str(tmp_path), "--json", str(told)]) == 0
    again = json.loads(told.read_text())["comparison"]["baseline"]["runs"][0]
    before = json.loads((server.folder / f"{name}.comparison.json").read_text())["baseline"]["runs"][0]
    for channel in ("weight_position", "fibre_force"):
        assert again[channel]["R"] == before[channel]["R"]


def test_stopping_keeps_what_was_recorded(server: Server, done: object) -> None:
    started = server.order(cycles=40)
    server.until(f"/experiments/{started['id']}", lambda e: e["phase"] == "motion")
    assert server.http.post(f"/experiments/{started['id']}/stop").status_code == 202
    view = server.ended(started["id"])
    assert view["state"] == "stopped"
    assert server.http.get(f"/runs/{view['run']}").json()["seconds"] < 20


def test_an_emergency_stop_holds_until_it_is_reset(server: Server, done: object) -> None:
    started = server.order(cycles=40)
    server.until(f"/experiments/{started['id']}", lambda e: e["phase"] == "motion")
    assert httpx.post(f"{server.url}/emergency-stop").json()["stopped"]
    view = server.ended(started["id"])
    assert view["state"] == "emergency-stopped"
    assert (server.folder / f"{view['run']}.h5").exists()
    refused = server.until("/stand", lambda stand: stand["state"] == "tripped") and server.http.post(
        "/experiments", json=ORDER
    )
    assert refused.status_code == 409
    assert "reset" in refused.json()["remedy"]
    assert server.http.post("/stand/reset").status_code == 200
    server.until("/stand", lambda stand: stand["state"] == "ready")
