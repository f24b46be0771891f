"""The live stream's hub: every watcher has a short queue of its own; who is slow loses blocks and is told how many."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from collections.abc import Iterable, Mapping
from typing import Any

QUEUE_BLOCKS = 64
#: blocks that are kept for who joins in the middle, 30 s
PAST_BLOCKS = 1500


class Watcher:
    """One client's lane: states by kind, of which only the newest counts, and a bounded queue of blocks."""

    def __init__(self, past: Iterable[str] = (), limit: int = QUEUE_BLOCKS) -> None:
        self._states: dict[str, str] = {}
        self._past, self._blocks = list(past), deque[str]()
        self._limit, self._ready = limit, asyncio.Event()
        if self._past:
            self._ready.set()
        self.dropped = 0

    def offer_state(self, kind: str, text: str) -> None:
        """Take a state message; it replaces one of its kind that was not yet sent."""
        self._states.pop(kind, None)
        self._states[kind] = text
        self._ready.set()

    def offer_block(self, text: str) -> None:
        """Take a block; the oldest goes, counted, where the queue is full."""
        if len(self._blocks) >= self._limit:
            self._blocks.popleft()
            self.dropped += 1
            self.offer_state("dropped", json.dumps({"type": "dropped", "blocks": self.dropped}))
        self._blocks.append(text)
        self._ready.set()

    async def next(self) -> list[str]:
        """All messages that wait, states first; waits until there is one."""
        await self._ready.wait()
        self._ready.clear()
        messages = [*self._states.values(), *self._past, *self._blocks]
        self._states.clear()
        self._past.clear()
        self._blocks.clear()
        return messages


class Hub:
    """Publishes to all watchers; `publish_*` may be called from any thread once `bind` was."""

    def __init__(self) -> None:
        self._watchers: set[Watcher] = set()
        self._last: dict[str, str] = {}
        self._past: deque[str] = deque(maxlen=PAST_BLOCKS)
        self._loop: asyncio.AbstractEventLoop | None = None

    def bind(self, loop: asyncio.AbstractEventLoop) -> None:
        """Say on which loop the watchers live."""
        self._loop = loop

    def __len__(self) -> int:
        return len(self._watchers)

    def join(self) -> Watcher:
        """A new watcher, who gets the newest state of each kind and the newest blocks at once."""
        watcher = Watcher(self._past)
        for kind, text in self._last.items():
            watcher.offer_state(kind, text)
        self._watchers.add(watcher)
        return watcher

    def leave(self, watcher: Watcher) -> None:
        """Forget a watcher."""
        self._watchers.discard(watcher)

    def publish_state(self, kind: str, content: Mapping[str, Any]) -> None:
        """Tell all what `kind` is now."""
        self._on_loop(self._state, kind, json.dumps({"type": kind, **content}, allow_nan=False))

    def publish_block(self, content: Mapping[str, Any]) -> None:
        """Send a block of samples to all."""
        self._on_loop(self._block, json.dumps({"type": "block", **content}, allow_nan=False, separators=(",", ":")))

    def _on_loop(self, call: Any, *arguments: str) -> None:
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(call, *arguments)

    def _state(self, kind: str, text: str) -> None:
        self._last[kind] = text
        for watcher in self._watchers:
            watcher.offer_state(kind, text)

    def clear_past(self) -> None:
        """Forget the blocks so far: a new run begins."""
        if self._loop is not None:
            self._loop.call_soon_threadsafe(self._past.clear)

    def _block(self, text: str) -> None:
        self._past.append(text)
        for watcher in self._watchers:
            watcher.offer_block(text)
