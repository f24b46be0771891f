"""The stand itself: status and preparation."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter
from pydantic import BaseModel, Field

from api.problem import RESPONSES
from api.routes._operator import TheOperator
from api.views import StandView, StepView

router = APIRouter(prefix="/stand", tags=["stand"], responses=RESPONSES)


class Jog(BaseModel):
    """A small move at a slow speed."""

    distance: float = Field(description="m, positive takes fibre in", examples=[0.001], ge=-0.02, le=0.02)


@router.get("", response_model=StandView)
async def status(operator: TheOperator) -> Any:
    """What the devices say, as last asked; asked again every few seconds while no experiment runs."""
    return operator.status()


@router.post("/home", response_model=StepView)
def home(operator: TheOperator) -> Any:
    """Find the drive's reference and go to where runs rest."""
    return operator.prepare("home")


@router.post("/jog", response_model=StepView)
def jog(step: Jog, operator: TheOperator) -> Any:
    """Move the drive a little."""
    return operator.prepare("jog", step.distance)


@router.post("/tare", response_model=StepView)
def tare(operator: TheOperator) -> Any:
    """Tare the gauges."""
    return operator.prepare("tare")


@router.post("/rest-check", response_model=StepView)
def rest_check(operator: TheOperator) -> Any:
    """Check the force at rest against the weight's."""
    return operator.prepare("rest-check")


@router.post("/reset", response_model=StepView)
def reset(operator: TheOperator) -> Any:
    """After a trip or an emergency stop: clear the drive's fault and allow motion again. Nothing moves by this."""
    return operator.prepare("reset")
