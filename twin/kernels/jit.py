"""Compile a kernel ahead of its first call and keep it on disk, until one of its own files changes.

Numba's cache looks only at the file a function stands in. A kernel spread over several files would go stale
unseen, so each family of files (those whose names begin alike) has a folder named by what the files say.

Only a kernel's entry points are `compiled`; its inner functions are `part`s, which are compiled into the entry
point and cost nothing when that comes from the cache.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba

HERE = Path(__file__).parent


def _base() -> Path:
    given = os.environ.get("NUMBA_CACHE_DIR")
    return Path(given) if given else Path.home() / ".cache" / "fibre-stand" / "numba"


@cache
def cache_folder(family: str, folder: Path = HERE) -> Path:
    """Where the compiled functions of `folder`'s files whose names begin with `family` are kept."""
    digest = hashlib.sha256()
    for file in sorted(folder.glob(f"{family}*.py")):
        digest.update(file.read_bytes())
    return _base() / f"{family}-{digest.hexdigest()[:12]}"


def compiler(family: str, folder: Path = HERE) -> Callable[..., Callable[[Callable[..., Any]], Any]]:
    """A decorator factory: `compiled("f8(f8)")` compiles eagerly, caches by `family` and releases the GIL."""

    def compiled(*signatures: str, **options: Any) -> Callable[[Callable[..., Any]], Any]:
        def decorate(function: Callable[..., Any]) -> Any:
            config: Any = numba.config
            before = config.CACHE_DIR
            config.CACHE_DIR = str(cache_folder(family, folder))
            try:
                settings: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", **options}
                return numba.njit(list(signatures), **settings)(function)
            finally:
                config.CACHE_DIR = before

        return decorate

    return compiled


def part(function: Callable[..., Any] | None = None, **options: Any) -> Any:
    """An inner function of a kernel: `@part` or `@part(fastmath=...)`; typed and compiled by whoever calls it."""
    settings: dict[str, Any] = {"nogil": True, "error_model": "numpy", **options}
    return numba.njit(**settings) if function is None else numba.njit(**settings)(function)
