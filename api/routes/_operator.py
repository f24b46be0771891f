"""The operator, as routes get it."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Request

from api.operator import Operator


async def _operator(request: Request) -> Operator:
    operator: Operator = request.app.state.operator
    return operator


TheOperator = Annotated[Operator, Depends(_operator)]
