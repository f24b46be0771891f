"""Who may do what, asked with plain ASGI requests."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI
from httpx import ASGITransport, AsyncClient, Response
from starlette.websockets import WebSocket

from api.access import Access, Guard, read_token
from stand.errors import InputError

HERE = "http://127.0.0.1:8000"
ACCESS = Access("a-token-of-good-length")


Ask = Callable[..., Response]


@pytest.fixture
def app() -> FastAPI:
    app = FastAPI()

    @app.post("/moves")
    @app.post("/emergency-stop")
    @app.get("/reads")
    def done() -> str:
        return "done"

    @app.websocket("/live")
    async def live(socket: WebSocket) -> None:
        await socket.accept()
        await socket.close()

    app.add_middleware(Guard, access=ACCESS)
    return app


@pytest.fixture
def ask(app: FastAPI) -> Ask:
    async def send(method: str, path: str, headers: dict[str, str]) -> Response:
        async with AsyncClient(transport=ASGITransport(app), base_url=HERE) as client:
            return await client.request(method, path, headers=headers)

    return lambda method, path, headers=None: asyncio.run(send(method, path, headers or {}))


def first_answer(app: FastAPI, origin: str) -> dict[str, Any]:
    """The first thing that a WebSocket from `origin` is told."""
    headers = [(b"host", b"127.0.0.1:8000"), (b"origin", origin.encode())]
    scope = {"type": "websocket", "path": "/live", "raw_path": b"/live", "headers": headers, "query_string": b""}
    told: list[dict[str, Any]] = []

    async def receive() -> dict[str, Any]:
        return {"type": "websocket.connect"}

    async def send(message: Any) -> None:
        told.append(message)

    asyncio.run(app({**scope, "subprotocols": [], "client": ("127.0.0.1", 1), "scheme": "ws"}, receive, send))
    return told[0]


def test_reading_needs_no_token(ask: Ask) -> None:
    assert ask("GET", "/reads").status_code == 200


def test_moving_without_the_token_is_refused_with_a_problem(ask: Ask) -> None:
    answer = ask("POST", "/moves")
    assert answer.status_code == 401
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["type"] == "/problems/token"


@pytest.mark.parametrize(
    "headers",
    [{"Authorization": f"Bearer {ACCESS.token}"}, {"Cookie": f"{ACCESS.cookie}={ACCESS.token}"}],
    ids=["header", "cookie"],
)
def test_the_token_opens_the_way(ask: Ask, headers: dict[str, str]) -> None:
    assert ask("POST", "/moves", headers=headers).status_code == 200


def test_a_wrong_token_does_not(ask: Ask) -> None:
    assert ask("POST", "/moves", headers={"Authorization": "Bearer wrong"}).status_code == 401


def test_stopping_is_never_refused_for_want_of_a_token(ask: Ask) -> None:
    assert ask("POST", "/emergency-stop").status_code == 200


def test_a_name_that_resolves_to_loopback_is_refused(ask: Ask) -> None:
    answer = ask("GET", "/reads", headers={"Host": "evil.example:8000"})
    assert answer.status_code == 403


@pytest.mark.parametrize("origin", ["http://evil.example", "http://127.0.0.1:9999", "null"])
def test_a_page_from_elsewhere_may_not_even_stop(ask: Ask, origin: str) -> None:
    headers = {"Origin": origin, "Authorization": f"Bearer {ACCESS.token}"}
    assert ask("POST", "/emergency-stop", headers=headers).status_code == 403


def test_a_websocket_from_elsewhere_is_refused(app: FastAPI) -> None:
    told = first_answer(app, "http://evil.example")
    assert (told["type"], told["code"]) == ("websocket.close", 4403)


def test_the_own_page_may_listen(app: FastAPI) -> None:
    assert first_answer(app, HERE)["type"] == "websocket.accept"


def test_a_token_file_with_a_short_word_is_refused(tmp_path: Path) -> None:
    (tmp_path / "token").write_text("short\n")
    with pytest.raises(InputError, match="16 characters"):
        read_token(tmp_path / "token")
