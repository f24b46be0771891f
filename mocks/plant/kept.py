"""Numba's cache for the plant's kernels, which stand in two files and call each other.

Numba looks at the file of a function only: one that calls a changed function of the other file would go stale unseen.
So they are kept in a folder named by what both files say.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba

FILES = ("forces.py", "march.py")


@cache
def folder() -> Path:
    """Where the compiled functions are kept."""
    digest = hashlib.sha256(b"".join((Path(__file__).parent / name).read_bytes() for name in FILES))
    given = os.environ.get("NUMBA_CACHE_DIR")
    base = Path(given) if given else Path.home() / ".cache" / "fibre-stand" / "numba"
    return base / f"plant-{digest.hexdigest()[:12]}"


def kernel(function: Callable[..., Any]) -> Any:
    """The function, compiled at its first call and kept."""
    config: Any = numba.config
    before = config.CACHE_DIR
    config.CACHE_DIR = str(folder())
    try:
        return numba.njit(cache=True)(function)
    finally:
        config.CACHE_DIR = before
