"""The live stream over WebSocket."""

from __future__ import annotations

import asyncio
from contextlib import suppress

from fastapi import APIRouter, WebSocket
from starlette.websockets import WebSocketDisconnect

from api.hub import Hub, Watcher

router = APIRouter()


@router.websocket("/live")
async def live(socket: WebSocket) -> None:
    """States (stand, experiment, job, runs) and blocks of samples, until the client leaves."""
    hub: Hub = socket.app.state.operator.hub
    await socket.accept()
    watcher = hub.join()
    sender = asyncio.create_task(_send(socket, watcher))
    try:
        while True:
            await socket.receive_text()
    except WebSocketDisconnect:
        pass
    finally:
        hub.leave(watcher)
        sender.cancel()
        with suppress(asyncio.CancelledError, Exception):
            await sender


async def _send(socket: WebSocket, watcher: Watcher) -> None:
    while True:
        for message in await watcher.next():
            await socket.send_text(message)
