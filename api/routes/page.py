"""The page at `/`, and the token's way into the browser."""

from __future__ import annotations

from pathlib import Path

from fastapi import APIRouter, Request
from fastapi.responses import FileResponse, RedirectResponse, Response

from api.access import Access

router = APIRouter(include_in_schema=False)
PAGE = Path(__file__).parent.parent / "page"
POLICY = "default-src 'self'; connect-src 'self'; img-src 'self' data:; frame-ancestors 'none'; base-uri 'none'"


@router.get("/")
def page(request: Request, token: str | None = None) -> Response:
    """The page; with `?token=` (the printed address) the token becomes a cookie and leaves the address."""
    access: Access = request.app.state.access
    if token is None:
        return _html("index.html")
    answer = RedirectResponse("/", status_code=303)
    if access.holds(token):
        answer.set_cookie(access.cookie, token, httponly=True, samesite="strict", path="/")
    return answer


@router.get("/docs")
def docs() -> Response:
    """The REST interface in words, from its OpenAPI document; works without internet."""
    return _html("docs.html")


def _html(name: str) -> FileResponse:
    return FileResponse(PAGE / name, headers={"Content-Security-Policy": POLICY, "Cache-Control": "no-cache"})
