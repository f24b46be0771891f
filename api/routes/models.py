"""The fibre models."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from api.catalogue import describe_model, load_models

router = APIRouter(prefix="/models", tags=["models"])


@router.get("")
def every() -> list[dict[str, Any]]:
    """All fibre models with their parameters."""
    return [describe_model(model) for model in load_models()]


@router.get("/{name}")
def one(name: str) -> dict[str, Any]:
    """One fibre model."""
    return describe_model(load_models(name)[0])
