"""Work after runs."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from api.problem import RESPONSES
from api.routes._operator import TheOperator

router = APIRouter(prefix="/jobs", tags=["jobs"], responses=RESPONSES)


@router.get("")
def every(operator: TheOperator) -> list[dict[str, Any]]:
    """All jobs since the server started, newest first."""
    return [job.view() for job in operator.jobs.list()]


@router.get("/{identity}")
def one(identity: str, operator: TheOperator) -> dict[str, Any]:
    """One job."""
    return operator.jobs.get(identity).view()
