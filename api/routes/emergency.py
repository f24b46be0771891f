"""The emergency stop, on a route of its own."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from api.routes._operator import TheOperator
from api.views import StopView

router = APIRouter(tags=["emergency stop"])


@router.post("/emergency-stop", response_model=StopView)
def emergency_stop(operator: TheOperator) -> Any:
    """Stop the drive at once, whoever asks: no token is needed to stop. A run in progress ends, its recording is kept.

    This is software: it does not replace the stand's hardware emergency stop.
    """
    return operator.emergency_stop()
