"""Who may do what: loopback names only, no foreign origin, and a token for whatever moves the stand.

A page from elsewhere in the operator's browser must not reach the stand: not by a name that resolves to
loopback (DNS rebinding: the Host is checked), not by a form or a script (the Origin is checked and the cookie
is SameSite=Strict), not by a WebSocket, which browsers open across origins (the same check).
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Mapping
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from pathlib import Path
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from api.problem import Problem, respond
from stand.errors import InputError

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
LOOPBACK = frozenset({"127.0.0.1", "localhost", "::1"})
#: no token: stopping must never be refused for want of one, and validating moves nothing
OPEN_PATHS = frozenset({"/emergency-stop", "/experiments/validate"})


@dataclass(frozen=True)
class Access:
    """token: what a mover must show. cookie: its cookie's name (cookies do not tell ports apart, so it holds one)."""

    token: str = field(default_factory=lambda: secrets.token_urlsafe(24), repr=False)
    cookie: str = "stand_token"

    def holds(self, shown: str | None) -> bool:
        """Whether `shown` is the token, compared in constant time."""
        return shown is not None and hmac.compare_digest(shown.encode(), self.token.encode())

    def shown_by(self, headers: Mapping[str, str]) -> bool:
        """Whether the request shows the token, as `Authorization: Bearer` or as the cookie."""
        scheme, _, value = headers.get("authorization", "").partition(" ")
        return (scheme.lower() == "bearer" and self.holds(value.strip())) or self.holds(self._cookie(headers))

    def _cookie(self, headers: Mapping[str, str]) -> str | None:
        try:
            found = SimpleCookie(headers.get("cookie", "")).get(self.cookie)
        except CookieError:
            return None
        return found.value if found else None


def read_token(path: Path) -> str:
    """The token in a file: its first line, at least 16 characters; InputError otherwise."""
    try:
        text = path.read_text().strip()
    except OSError as error:
        raise InputError("can't read the token", where=str(path), remedy=str(error)) from error
    if len(text) < 16 or any(c.isspace() for c in text):
        raise InputError("a token is one word of 16 characters or more", where=str(path), remedy="Make a longer one")
    return text


class Guard:
    """ASGI middleware that refuses with a problem; see the module."""

    def __init__(self, app: ASGIApp, access: Access) -> None:
        self._app, self._access = app, access

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope, Headers(scope=scope))
        if refusal is None:
            await self._app(scope, receive, send)
        elif scope["type"] == "http":
            await respond(refusal)(scope, receive, send)
        else:
            await send({"type": "websocket.close", "code": 4403, "reason": refusal.title})

    def _refusal(self, scope: Scope, headers: Headers) -> Problem | None:
        host = headers.get("host", "")
        if urlsplit(f"//{host}").hostname not in LOOPBACK:
            return _forbidden("This server answers to loopback names only", f"Host: {host}")
        origin = headers.get("origin")
        if origin is not None and origin.partition("://")[2] != host:
            return _forbidden("A page from elsewhere may not use this stand", f"Origin: {origin}")
        moves = scope["type"] == "http" and scope["method"] not in SAFE_METHODS and scope["path"] not in OPEN_PATHS
        if moves and not self._access.shown_by(headers):
            detail = "Open the address that the server printed, or send `Authorization: Bearer TOKEN`"
            title = "Whatever moves the stand needs the token"
            return Problem(type="/problems/token", title=title, status=401, detail=detail)
        return None


def _forbidden(title: str, detail: str) -> Problem:
    return Problem(type="/problems/origin", title=title, status=403, detail=detail)
