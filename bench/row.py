"""One line of the table of figures."""

from __future__ import annotations

from typing import Any

Row = dict[str, Any]


def row(job: str, peer: str, ratio: float | None, found: float | None, note: str = "") -> Row:
    """job, peer, ratio (how many times faster than the peer, or than asked), error beside it; null where not made."""
    return {"job": job, "peer": peer, "ratio": ratio, "error": found, "note": note}
