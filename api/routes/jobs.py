"""Work after runs."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from api.problem import RESPONSES
from api.routes._operator import TheOperator
from api.views import JobView

router = APIRouter(prefix="/jobs", tags=["jobs"], responses=RESPONSES)


@router.get("", response_model=list[JobView])
def every(operator: TheOperator) -> Any:
    """All jobs since the server started, newest first."""
    return [job.view() for job in operator.jobs.list()]


@router.get("/{identity}", response_model=JobView)
def one(identity: str, operator: TheOperator) -> Any:
    """One job."""
    return operator.jobs.get(identity).view()
