"""The acquisition process: `python -m stand.runs FD` takes its order from an inherited socket and reports to it."""

from __future__ import annotations

import signal
import sys
import threading
from multiprocessing.connection import Connection
from pathlib import Path

from stand.config import Stand
from stand.errors import StandError
from stand.runs.halt import obey
from stand.runs.link import Tap
from stand.runs.messages import Failed, Finished
from stand.runs.order import Order, RunOrder, StepOrder
from stand.runs.priority import ahead, keep_at_hand, prefer
from stand.runs.replay import perform_replay
from stand.runs.rig import Rig
from stand.runs.run import ordered_stand, perform, run_path
from stand.runs.steps import perform_step

SWITCH_INTERVAL = 0.0005


def main() -> int:
    """Take the order, carry it out, say how it ended."""
    sys.setswitchinterval(SWITCH_INTERVAL)  # the quick stop's thread must not wait 5 ms for its turn
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    connection = Connection(int(sys.argv[1]))
    stand, order = connection.recv()
    prefer()
    keep_at_hand()
    with ahead():
        tap = Tap(connection)
    last = _carry_out(stand, order, connection, tap)
    tap.send(last)
    tap.close()
    return 1 if isinstance(last, Failed) else 0


def _carry_out(stand: Stand, order: Order, connection: Connection, tap: Tap) -> Finished | Failed:
    path: Path | None = None
    try:
        if isinstance(order, StepOrder):
            with _rig(stand, order, connection, tap, None) as rig:
                return perform_step(rig, order)
        stand = ordered_stand(stand, order)
        path = run_path(stand, order)
        with _rig(stand, order, connection, tap, path) as rig:
            return perform_replay(rig, order, path) if order.replay else perform(rig, order, path)
    except StandError as error:
        kept = path if path is not None and path.exists() else None
        return Failed(type(error).__name__, error.what, error.where, error.value, error.remedy, kept)
    except Exception as error:  # whatever it is, whoever started the run must hear of it
        kept = path if path is not None and path.exists() else None
        return Failed(type(error).__name__, str(error), "acquisition", remedy="Report this with the log", path=kept)


def _rig(stand: Stand, order: Order, connection: Connection, tap: Tap, path: Path | None) -> Rig:
    moves = not (isinstance(order, RunOrder) and order.replay)
    report = path.with_suffix(".guardian.json") if path is not None else None
    rig = Rig(stand, tap.send, moves=moves, report=report)
    threading.Thread(target=obey, args=(connection, rig.halt, rig.supervisor), name="orders", daemon=True).start()
    signal.signal(signal.SIGTERM, lambda *_: rig.halt.want("terminated"))
    return rig


if __name__ == "__main__":
    sys.exit(main())
