"""Errors as problem+json (RFC 9457): type, title, status, detail, and what/where/value/remedy beside them."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field
from starlette.exceptions import HTTPException

from stand.errors import DeviceError, InputError, SafetyTrip, StandError

MEDIA_TYPE = "application/problem+json"


class FieldError(BaseModel):
    """One field that can't be used."""

    field: str = Field(examples=["amplitude"])
    message: str = Field(examples=["the drive's travel is 100 mm"])


class Problem(BaseModel):
    """RFC 9457 problem details."""

    type: str = Field(default="about:blank", examples=["/problems/input"])
    title: str = Field(examples=["The input can't be used"])
    status: int = Field(examples=[422])
    detail: str = Field(default="", examples=["amplitude: beyond the drive's travel (got 0.12). At most 0.1 m"])
    where: str = ""
    remedy: str = ""
    errors: list[FieldError] = []


class NotFound(StandError):
    """No such resource."""


class Conflict(StandError):
    """The stand's state does not allow it now."""


_KINDS: tuple[tuple[type[StandError], str, str, int], ...] = (
    (NotFound, "/problems/not-found", "There is no such thing here", 404),
    (Conflict, "/problems/conflict", "Not while the stand is in this state", 409),
    (InputError, "/problems/input", "The input can't be used", 422),
    (SafetyTrip, "/problems/trip", "The stand was stopped", 409),
    (DeviceError, "/problems/device", "A device didn't do it", 502),
    (StandError, "/problems/failed", "It failed", 500),
)

#: for a router's `responses`, so that OpenAPI tells how errors look
RESPONSES: dict[int | str, dict[str, Any]] = {
    "4XX": {"model": Problem, "description": "problem details", "content": {MEDIA_TYPE: {}}}
}


def of(error: StandError) -> Problem:
    """The problem that says what `error` says."""
    kind = next(row for row in _KINDS if isinstance(error, row[0]))
    return Problem(
        type=kind[1], title=kind[2], status=kind[3], detail=str(error), where=error.where, remedy=error.remedy
    )


def respond(problem: Problem) -> JSONResponse:
    """The problem as an HTTP response."""
    return JSONResponse(problem.model_dump(), status_code=problem.status, media_type=MEDIA_TYPE)


def install(app: FastAPI) -> None:
    """Make every error of `app` a problem."""
    app.exception_handler(StandError)(_stand_error)
    app.exception_handler(RequestValidationError)(_invalid)
    app.exception_handler(HTTPException)(_http)
    app.exception_handler(Exception)(_unexpected)


async def _stand_error(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, StandError)
    return respond(of(error))


async def _invalid(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)
    found = [FieldError(field=_field(e["loc"]), message=str(e["msg"])) for e in error.errors()]
    detail = "; ".join(f"{e.field}: {e.message}" for e in found)
    title = "The request does not have the stated form"
    return respond(Problem(type="/problems/form", title=title, status=422, detail=detail, errors=found))


def _field(location: tuple[int | str, ...]) -> str:
    parts = [str(part) for part in location if part not in ("body", "query", "path")]
    return ".".join(parts) or "body"


async def _http(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, HTTPException)
    title = HTTPStatus(error.status_code).phrase
    return respond(Problem(title=title, status=error.status_code, detail=str(error.detail)))


async def _unexpected(_: Request, error: Exception) -> JSONResponse:
    detail = f"{type(error).__name__}: {error}"
    return respond(Problem(type="/problems/program", title="An error of the program itself", status=500, detail=detail))
