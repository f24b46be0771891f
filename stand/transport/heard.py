"""When the host's network had bytes, rather than when a program got round to reading them: Linux's receive stamps.

A reader that waits for a processor stamps its answers late, and that goes into the drive's clock as if the drive had
been slow. The kernel notes the time when a packet comes in (SO_TIMESTAMPNS, socket(7)); for a stream it is that of the
last bytes read (tcp_recvmsg).
"""

from __future__ import annotations

import socket
import struct
import sys
import time
from collections.abc import Iterable

#: Linux's number for the option and for the note that comes with the bytes; Python's socket module does not name it
_STAMPS = 35
_STAMP = struct.Struct("@ll")
ROOM = socket.CMSG_SPACE(_STAMP.size)
#: s: an older stamp is no stamp: the host's clock of the day was set in between
OLDEST = 1.0

Note = tuple[int, int, bytes]


def ask_for_stamps(link: socket.socket) -> None:
    """Have the kernel note when bytes come; where it can't, none are noted."""
    if sys.platform == "linux":
        try:
            link.setsockopt(socket.SOL_SOCKET, _STAMPS, 1)
        except OSError:
            return


def age(notes: Iterable[Note]) -> float:
    """How long ago the bytes came that were read with these notes, s; 0 where nothing tells."""
    now = time.time_ns()
    for level, kind, data in notes:
        if level == socket.SOL_SOCKET and kind == _STAMPS and len(data) >= _STAMP.size:
            seconds, nanoseconds = _STAMP.unpack_from(data)
            past = (now - seconds * 1_000_000_000 - nanoseconds) * 1e-9
            return past if 0.0 <= past < OLDEST else 0.0
    return 0.0
