"""Experiments: validate, create, watch, stop."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Response

from api.orders import Order, Validation, validate
from api.problem import RESPONSES
from api.routes._operator import TheOperator
from api.views import ExperimentView

router = APIRouter(prefix="/experiments", tags=["experiments"], responses=RESPONSES)


@router.post("/validate")
def validate_order(order: Order, operator: TheOperator) -> Validation:
    """Say whether an order is within the stand's limits, what it would do, and why not. Nothing moves."""
    return validate(order, operator.stand)


@router.post("", status_code=201, response_model=ExperimentView)
def create(order: Order, operator: TheOperator, response: Response) -> Any:
    """Start an experiment; 409 while another one runs."""
    experiment = operator.start(order)
    response.headers["Location"] = f"/experiments/{experiment.id}"
    return experiment.view()


@router.get("", response_model=list[ExperimentView])
def every(operator: TheOperator) -> Any:
    """The experiments since the server started, newest first."""
    return [experiment.view() for experiment in operator.experiments()]


@router.get("/{identity}", response_model=ExperimentView)
def one(identity: str, operator: TheOperator) -> Any:
    """Watch one experiment (or follow `/live`)."""
    return operator.experiment(identity).view()


@router.post("/{identity}/stop", status_code=202, response_model=ExperimentView)
def stop(identity: str, operator: TheOperator) -> Any:
    """End the experiment early in an orderly way; the recording is kept."""
    return operator.stop(identity).view()
