"""The application: routers, the guard before them, problems for errors, the page, and who lives as long as it does."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from importlib.metadata import version
from pathlib import Path

from fastapi import FastAPI
from starlette.staticfiles import StaticFiles

from api import problem
from api.access import Access, Guard
from api.operator import Operator
from api.routes import diagnoses, emergency, experiments, jobs, live, models, page, runs, situations, stand

PAGE = Path(__file__).parent / "page"

DESCRIPTION = """One fibre test stand: experiments, their live stream, recordings and what was computed from them.

Whatever moves the stand needs the token (`Authorization: Bearer TOKEN`, or the cookie that the printed address
sets); reading, validating and the emergency stop do not. Errors are problem details (RFC 9457)."""


def create_app(operator: Operator, access: Access) -> FastAPI:
    """The ASGI application around one operator."""

    @asynccontextmanager
    async def life(app: FastAPI) -> AsyncIterator[None]:
        operator.open(asyncio.get_running_loop())
        try:
            yield
        finally:
            await asyncio.to_thread(operator.close)

    app = FastAPI(
        title="Fibre stand",
        version=version("fibre-stand"),
        description=DESCRIPTION,
        lifespan=life,
        docs_url=None,  # FastAPI's own pages need the internet; ours is at the same address
        redoc_url=None,
    )
    app.state.operator, app.state.access = operator, access
    problem.install(app)
    for module in (experiments, emergency, runs, stand, situations, models, diagnoses, jobs, live, page):
        app.include_router(module.router)
    app.mount("/page", StaticFiles(directory=PAGE), name="page")
    app.add_middleware(Guard, access=access)
    return app
