"""Live blocks, joined."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stand.clock import LiveBlock


def joined(blocks: Sequence[LiveBlock]) -> LiveBlock:
    """Consecutive blocks as one."""
    columns = ("time", "x", "u", "F", "quality")
    arrays = {name: np.concatenate([getattr(block, name) for block in blocks]) for name in columns}
    return LiveBlock(first=blocks[0].first, newest_arrival=blocks[-1].newest_arrival, **arrays)
