"""Runs: the list, each one's file, report and results."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fastapi import APIRouter
from fastapi.responses import FileResponse

from api.problem import RESPONSES
from api.routes._operator import TheOperator
from api.views import ExperimentView, JobView, RunView

router = APIRouter(prefix="/runs", tags=["runs"], responses=RESPONSES)

#: reports carry their own scripts and data and need nothing else; they may not act as this server's page
REPORT_POLICY = "sandbox allow-scripts allow-downloads allow-popups; default-src 'none'; script-src 'unsafe-inline'; "
REPORT_POLICY += "style-src 'unsafe-inline'; img-src data: blob:; font-src data:"


@router.get("", response_model=list[RunView])
def every(operator: TheOperator) -> Any:
    """The recordings, newest first, with scores where they were compared."""
    return operator.list_runs()


@router.get("/{name}", response_model=RunView)
def one(name: str, operator: TheOperator) -> Any:
    """One recording's summary, with links to what was computed from it and the jobs that do."""
    path = operator.runs.path(name)
    jobs = [job.view() for job in operator.jobs.list() if str(path) in job.files]
    return {**operator.runs.summary(path), "jobs": jobs}


@router.get("/{name}/file", response_class=FileResponse)
def file(name: str, operator: TheOperator) -> FileResponse:
    """The recording itself, HDF5."""
    return FileResponse(operator.runs.path(name), media_type="application/x-hdf5", filename=f"{name}.h5")


@router.get("/{name}/comparison", response_class=FileResponse)
def comparison(name: str, operator: TheOperator) -> FileResponse:
    """The comparison with the model, JSON."""
    return FileResponse(operator.runs.file(name, "comparison"), media_type="application/json")


@router.get("/{name}/comparison-page", response_class=FileResponse)
def comparison_page(name: str, operator: TheOperator) -> FileResponse:
    """The comparison as one self-contained page."""
    return _page(operator.runs.file(name, "comparison-page"))


@router.get("/{name}/diagnosis", response_class=FileResponse)
def diagnosis(name: str, operator: TheOperator) -> FileResponse:
    """The verdict on this run, JSON."""
    return FileResponse(operator.runs.file(name, "diagnosis"), media_type="application/json")


@router.get("/{name}/diagnosis-page", response_class=FileResponse)
def diagnosis_page(name: str, operator: TheOperator) -> FileResponse:
    """The verdict as one self-contained page."""
    return _page(operator.runs.file(name, "diagnosis-page"))


@router.get("/{name}/model", response_class=FileResponse)
def model(name: str, operator: TheOperator) -> FileResponse:
    """The extended model that the diagnosis found, TOML."""
    return FileResponse(operator.runs.file(name, "model"), media_type="application/toml", filename=f"{name}.model.toml")


@router.post("/{name}/comparison", status_code=202, response_model=JobView)
def compare(name: str, operator: TheOperator) -> Any:
    """Compare again, as a job."""
    return operator.jobs.submit("compare", [operator.runs.path(name)]).view()


@router.post("/{name}/next-experiment", status_code=201, response_model=ExperimentView)
def next_experiment(name: str, operator: TheOperator) -> Any:
    """Run the experiment that this run's diagnosis proposes, then diagnose the campaign with it."""
    return operator.next_experiment(name).view()


def _page(path: Path) -> FileResponse:
    return FileResponse(path, media_type="text/html", headers={"Content-Security-Policy": REPORT_POLICY})
