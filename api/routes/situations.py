"""The presets of the papers."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from api.catalogue import describe_situations

router = APIRouter(prefix="/situations", tags=["situations"])


@router.get("")
def every() -> list[dict[str, Any]]:
    """The tested situations of the papers as orders, with the published R."""
    return describe_situations()
