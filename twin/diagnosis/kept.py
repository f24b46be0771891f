"""What depends on few parameters only, made once and kept for a while."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")


class Kept(threading.local):
    """Things by key, of whose kind (a key's first word) only the newest stay; each thread its own.

    A key that holds an id has what it names kept beside what was made.
    """

    def __init__(self) -> None:
        self._found: dict[tuple[Any, ...], Any] = {}

    def keep(self, key: tuple[Any, ...], most: int, make: Callable[[], T]) -> T:
        """What `make` makes, made once."""
        if key not in self._found:
            made = make()
            self.forget(key[0], most - 1)
            self._found[key] = made
        kept: T = self._found[key]
        return kept

    def forget(self, kind: str, most: int = 0) -> None:
        """Drops all but the newest of a kind."""
        mine = [key for key in self._found if key[0] == kind]
        for old in mine[: max(len(mine) - most, 0)]:
            del self._found[old]
