"""What a recording says of the stand that it was made on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stand.errors import InputError

if TYPE_CHECKING:
    from stand.config import Stand


def recorded_stand(recording: Path) -> tuple[Stand, float]:
    """The stand as configured when the run was recorded, and the run's length in s."""
    import h5py

    from stand.config import load_stand_text
    from stand.recording import read_recording

    run = read_recording(recording)
    with h5py.File(recording, "r") as file:
        stored = file.get("entry/configuration")
        if stored is None:
            remedy = "Only a run recorded by this software holds raw bytes to replay"
            raise InputError("no /entry/configuration", where=str(recording), remedy=remedy)
        text = stored[()].decode()
    stand = load_stand_text(text, f"{recording}:/entry/configuration")
    setup = run.setup.with_values(uncertainty=dict(run.setup.uncertainty))  # a plain dict goes to another process
    return stand.with_setup(setup), float(run.time[-1] - run.time[0]) + run.dt
