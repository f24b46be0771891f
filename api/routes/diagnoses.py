"""Diagnoses of one run or a campaign, as jobs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

from fastapi import APIRouter, Response
from pydantic import BaseModel, Field

from api.problem import RESPONSES, NotFound
from api.routes._operator import TheOperator
from api.views import DiagnosisView, JobView

router = APIRouter(prefix="/diagnoses", tags=["diagnoses"], responses=RESPONSES)


class DiagnosisOrder(BaseModel):
    """Which recordings to explain together."""

    runs: Annotated[list[str], Field(min_length=1, examples=[["20261121T101500Z_trapezoidal_1.25Hz"]])]


@router.post("", status_code=202, response_model=JobView)
def create(order: DiagnosisOrder, operator: TheOperator, response: Response) -> Any:
    """Diagnose; the answer is a job to watch."""
    job = operator.jobs.submit("diagnose", [operator.runs.path(name) for name in order.runs])
    response.headers["Location"] = f"/diagnoses/{job.id}"
    return job.view()


@router.get("", response_model=list[JobView])
def every(operator: TheOperator) -> Any:
    """All diagnoses since the server started, newest first."""
    return [job.view() for job in operator.jobs.list("diagnose")]


@router.get("/{identity}", response_model=DiagnosisView)
def one(identity: str, operator: TheOperator) -> Any:
    """A diagnosis: how far it is, and the verdict once it is done."""
    job = operator.jobs.get(identity)
    if job.kind != "diagnose":
        raise NotFound("no such diagnosis", where="diagnoses", value=identity)
    written = job.result.get("json")
    verdict = json.loads(Path(written).read_text()) if job.state == "done" and written else None
    return {**job.view(), "verdict": verdict}
