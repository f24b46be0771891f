"""The quick stop's telegrams and where they go, as the guardian and the safety thread need them."""

from __future__ import annotations

from stand.config import RtuLink, Stand
from stand.drive.drive import quick_stop_telegrams
from stand.guardian.client import StopOrder


def stop_order(stand: Stand) -> StopOrder:
    """How to stop this stand's drive without its driver."""
    link, telegrams = stand.drive.link, tuple(quick_stop_telegrams(stand))
    if isinstance(link, RtuLink):
        return StopOrder("serial", link.port, 0, telegrams)
    return StopOrder("tcp", link.host, link.port, telegrams)
